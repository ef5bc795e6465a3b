// The page and the way in.

#include "absl/strings/str_cat.h"
#include "coordinator/web/page_files.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"

namespace bandsaw::coordinator {

void add_page(HttpServer& server) {
  for (const PageFile& file : page_files()) {
    const auto send = [&file](const httplib::Request&, httplib::Response& response) {
      response.set_content(file.bytes.data(), file.bytes.size(), std::string(file.type));
    };
    if (file.name == "index.html") {
      server.Get("/", send);
    } else {
      server.Get(absl::StrCat("/", std::string(file.name)), send);
    }
  }
}

void add_login(HttpServer& server, Access& access) {
  server.Get("/api/login", [&access](const httplib::Request& request, httplib::Response& response) {
    web::LoginState state;
    state.set_logged_in(access.logged_in(request));
    reply(response, state);
  });
  server.Post("/api/login", [&access](const httplib::Request& request, httplib::Response& response,
                                      const httplib::ContentReader& body) {
    web::Login login;
    absl::Status status = read_json(body, login);
    if (status.ok()) {
      status = access.log_in(request, login.secret(), response);
    }
    if (status.ok()) {
      reply(response, web::Login());
    } else {
      refuse(response, status);
    }
  });
  server.Post("/api/logout", [&access](const httplib::Request& request, httplib::Response& response,
                                       const httplib::ContentReader&) {
    access.log_out(request, response);
    reply(response, web::Login());
  });
}

}  // namespace bandsaw::coordinator
