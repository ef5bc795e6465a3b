// The page and the login.

#include "absl/strings/str_cat.h"
#include "coordinator/web/page_files.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"

namespace bandsaw::coordinator {

void add_page(Router& router) {
  for (const PageFile& file : page_files()) {
    router.get(file.name == "index.html" ? "/" : absl::StrCat("/", file.name),
               [&file](const HttpRequest&) {
                 return HttpReply{.type = std::string(file.type), .bytes = file.bytes};
               });
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
    HttpReply done = reply(web::Login());
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
