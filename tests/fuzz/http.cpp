// Fuzz target (fuzz.h): a request to the dashboard. Each input is used twice. In one use the input
// is the bytes that arrive on a connection. In the other use the input is a list of header lines
// "Name: value" up to an empty line, and then the body; a line without ": " is the request's
// target. In this form mutations reach the handlers easily.

#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <sstream>

#include "coordinator/web/access.h"
#include "coordinator/web/exchange.h"
#include "coordinator/web/reply.h"
#include "proto/link/identity.h"
#include "proto/web.pb.h"
#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace bandsaw::coordinator;

/// Runs the checks that the dashboard makes for each request, without regard to their results, and
/// answers like the dashboard's login.
HttpReply answer(Access& access, const HttpRequest& request, const HttpBody& body) {
  access.check(request).IgnoreError();
  access.logged_in(request);
  is_own_host(request.header("Host"), "desk", "farm.example.org");
  bandsaw::web::Login login;
  HttpReply done = text_reply("0123456789", "text/plain");
  if (const absl::Status status = read_json(body, login); !status.ok()) {
    return refuse(status);
  }
  access.log_in(request, login.secret(), done).IgnoreError();
  return done;
}

/// Sends the input over a connection to the dashboard's code, as its raw bytes.
void over_a_connection(Access& access, absl::Span<const std::uint8_t> input) {
  std::array<int, 2> sockets{};
  BANDSAW_CHECK(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets.data()) == 0, "socketpair");
  send(sockets[0], input.data(), input.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  shutdown(sockets[0], SHUT_WR);
  {
    Connection connection(sockets[1], nullptr);
    exchange(connection,
             [&](const HttpRequest& request, const HttpBody& body) {
               return answer(access, request, body);
             },
             {{"X-Content-Type-Options", "nosniff"}});
  }
  close(sockets[1]);
  close(sockets[0]);
}

/// Makes a request of the lines of the input and answers it. If the request's headers ask for a
/// range of bytes, then reduces the answer to this range.
void as_lines(Access& access, absl::Span<const std::uint8_t> input) {
  std::istringstream lines(bandsaw::fuzz::text(input));
  HttpRequest request;
  request.method = "POST";
  std::string line;
  while (std::getline(lines, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) {
      parse_target(line, request);
    } else {
      request.headers.emplace_back(line.substr(0, colon), line.substr(colon + 2));
    }
  }
  std::string body;
  std::getline(lines, body, '\0');
  bool given = false;
  const HttpBody read = [&]() -> absl::StatusOr<absl::string_view> {
    return std::exchange(given, true) ? absl::string_view() : absl::string_view(body);
  };
  HttpReply reply = answer(access, request, read);
  request.method = "GET";
  const std::size_t size = reply.bytes.size();
  reply = with_range(request, std::move(reply));
  BANDSAW_CHECK(reply.bytes.size() <= size, "a range is a part of the answer");
}

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  static Access access({.key_pem = "",
                        .certificate_pem = "",
                        .certificate_digest = {},
                        .worker_secret = std::string(22, 'w'),
                        .farm_secret = std::string(22, 'f')},
                       /*secure=*/true, /*host=*/"farm.example.org");
  as_lines(access, input);
  over_a_connection(access, input);
}
