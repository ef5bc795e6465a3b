// Compares a path with the patterns of the routes in order; `*` stands for one part between
// slashes.

#include "coordinator/web/router.h"

#include <utility>

#include "absl/strings/match.h"
#include "coordinator/web/reply.h"

namespace bandsaw::coordinator {

void Router::add(bool post, const std::string& pattern, HttpHandler answer) {
  const std::size_t star = pattern.find('*');
  const bool captures = star != std::string::npos;
  routes_.push_back({.post = post,
                     .prefix = pattern.substr(0, star),
                     .suffix = captures ? pattern.substr(star + 1) : "",
                     .captures = captures,
                     .answer = std::move(answer)});
}

void Router::get(std::string pattern, std::function<HttpReply(const HttpRequest&)> answer) {
  add(/*post=*/false, pattern,
      [answer = std::move(answer)](const HttpRequest& request, const HttpBody&) {
        return answer(request);
      });
}

void Router::post(std::string pattern, HttpHandler answer) {
  add(/*post=*/true, pattern, std::move(answer));
}

bool Router::fits(const Route& route, HttpRequest& request) {
  const std::string& path = request.path;
  if (route.post != (request.method == "POST")) {
    return false;
  }
  if (!route.captures) {
    return path == route.prefix;
  }
  const std::size_t fixed = route.prefix.size() + route.suffix.size();
  if (path.size() <= fixed || !absl::StartsWith(path, route.prefix) ||
      !absl::EndsWith(path, route.suffix)) {
    return false;
  }
  request.captured = path.substr(route.prefix.size(), path.size() - fixed);
  return request.captured.find('/') == std::string::npos;
}

HttpReply Router::answer(HttpRequest request, const HttpBody& body) const {
  for (const Route& route : routes_) {
    if (fits(route, request)) {
      return route.answer(request, body);
    }
  }
  return refuse(absl::NotFoundError("there is nothing of this name here"));
}

}  // namespace bandsaw::coordinator
