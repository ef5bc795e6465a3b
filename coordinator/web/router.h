#pragma once

// Finds the handler of a request by its path.

#include <functional>
#include <string>
#include <vector>

#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// One thread adds all routes first. After that, answer() is thread-safe.
class Router {
 public:
  /// Adds a route for GET and HEAD of paths equal to `pattern`. The pattern may have one "*", which
  /// matches one or more characters other than "/". The handler finds the matched characters in
  /// `HttpRequest::captured`.
  void get(std::string pattern, std::function<HttpReply(const HttpRequest&)> answer);
  /// Adds a route for POST, with a pattern as for get(). The handler may read the body.
  void post(std::string pattern, HttpHandler answer);

  /// Returns the response of the first matching route, or a 404.
  HttpReply answer(HttpRequest request, const HttpBody& body) const;

 private:
  struct Route {
    bool post = false;
    std::string prefix;  ///< part of the path before "*"
    std::string suffix;  ///< part of the path after "*"
    bool captures = false;
    HttpHandler answer;
  };
  void add(bool post, const std::string& pattern, HttpHandler answer);
  /// Returns true if the route matches the method and the path. May change `request.captured`.
  static bool fits(const Route& route, HttpRequest& request);

  std::vector<Route> routes_;
};

}  // namespace bandsaw::coordinator
