// The handlers of the requests for the files of the dashboard's page, and for login and logout.

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/page_files.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"

namespace bandsaw::coordinator {

namespace {

/// The Content-Security-Policy of the page for browsers that render, and of its scripts, which run
/// as web workers. No other page may compile WebAssembly and start web workers.
constexpr char kJoinPolicy[] =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src "
    "'self'; "
    "img-src 'self'; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors "
    "'none'";

/// Returns the path of a file in its address. "index.html" has the path "/", and "join.html" has
/// the path "/join".
std::string path_of(const PageFile& file) {
  if (file.name == "index.html") {
    return "/";
  }
  return file.name == "join.html" ? "/join" : absl::StrCat("/", file.name);
}

}  // namespace

void add_page(Router& router) {
  for (const PageFile& file : page_files()) {
    HttpReply reply{.type = std::string(file.type), .bytes = file.bytes};
    if (absl::StartsWith(file.name, "join")) {
      reply.headers.emplace_back("Content-Security-Policy", kJoinPolicy);
    }
    router.get(path_of(file), [reply](const HttpRequest&) { return reply; });
  }
}

void add_login(Router& router, Access& access) {
  router.get("/api/login", [&access](const HttpRequest& request) {
    web::LoginState state;
    state.set_logged_in(access.logged_in(request));
    return reply(state);
  });
  router.post("/api/login", [&access](const HttpRequest& request, const HttpBody& body) {
    web::Login login;
    HttpReply done = reply(web::Login());  // an empty message; log_in() adds the cookie
    absl::Status status = read_json(body, login);
    if (status.ok()) {
      status = access.log_in(request, login.secret(), done);
    }
    return status.ok() ? done : refuse(status);
  });
  router.post("/api/logout", [&access](const HttpRequest& request, const HttpBody&) {
    HttpReply done = reply(web::Login());
    access.log_out(request, done);
    return done;
  });
}

}  // namespace bandsaw::coordinator
