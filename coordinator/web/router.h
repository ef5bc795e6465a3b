#pragma once

// Which function answers which path.

#include <functional>
#include <string>
#include <vector>

#include "coordinator/web/http.h"

namespace bandsaw::coordinator {

/// Filled first, then used by any threads.
class Router {
 public:
  /// Routes GET and HEAD of the paths that are equal to `pattern`. A "*" in it, of which there is
  /// at most one, stands for one or more characters other than "/", which are
  /// `HttpRequest::captured`.
  void get(std::string pattern, std::function<HttpReply(const HttpRequest&)> answer);
  /// The same for POST, whose handler may read the body.
  void post(std::string pattern, HttpHandler answer);

  /// The answer of the first route that fits; a 404 where none does.
  HttpReply answer(HttpRequest request, const HttpBody& body) const;

 private:
  struct Route {
    bool post = false;
    std::string prefix;  ///< of the path: what comes before "*"
    std::string suffix;  ///< what comes after it
    bool captures = false;
    HttpHandler answer;
  };
  void add(bool post, const std::string& pattern, HttpHandler answer);
  static bool fits(const Route& route, HttpRequest& request);

  std::vector<Route> routes_;
};

}  // namespace bandsaw::coordinator
