// A request of a browser: lines "Name: value" up to an empty one, then the body. What cpp-httplib
// makes of bytes is its own; what we make of requests is tried.

#include <sstream>

#include "coordinator/web/access.h"
#include "coordinator/web/reply.h"
#include "proto/link/identity.h"
#include "proto/web.pb.h"
#include "tests/fuzz/fuzz.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  static coordinator::Access access({.key_pem = "",
                                     .certificate_pem = "",
                                     .certificate_digest = {},
                                     .worker_secret = std::string(22, 'w'),
                                     .farm_secret = std::string(22, 'f')},
                                    true);
  std::istringstream lines(text(input));
  httplib::Request request;
  request.method = "POST";
  std::string line;
  while (std::getline(lines, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) {
      request.path = line;
    } else {
      request.headers.emplace(line.substr(0, colon), line.substr(colon + 2));
    }
  }
  std::string body;
  std::getline(lines, body, '\0');
  access.check(request).IgnoreError();
  access.logged_in(request);
  coordinator::is_own_host(request.get_header_value("Host"), "desk");
  httplib::Response response;
  access.log_in(request, body, response).IgnoreError();
  const httplib::ContentReader reader(
      [&](const httplib::ContentReceiver& take) { return take(body.data(), body.size()); },
      [](const httplib::MultipartContentHeader&, const httplib::ContentReceiver&) {
        return false;
      });
  web::Login login;
  coordinator::read_json(reader, login).IgnoreError();
}
