// Tests access to the dashboard: logins, secrets, foreign sites, and limits on connections.

#include "coordinator/web/access.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "proto/link/join.h"
#include "proto/wire/limits.h"
#include "tests/unit/web/web_farm.h"

namespace bandsaw::coordinator {
namespace {

using AccessTest = WebTest;

int status_of(const std::optional<test::HttpAnswer>& result) {
  return result ? result->status : -1;
}

// The header Host of a request must name this dashboard. A foreign page whose name resolves to this
// machine (DNS rebinding) sends the foreign name. The arguments of is_own_host are the header, the
// name of this machine, and the name that the user has given to the dashboard.
TEST(OwnHost, IsAnAddressLocalhostOrTheMachinesName) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:8787", "192.168.1.5:80", "[::1]:8787", "[::1]",
                           "localhost:8787", "LOCALHOST", "desk", "desk.local:8787"}) {
    EXPECT_TRUE(is_own_host(host, "desk", "127.0.0.1")) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:8787", "127.0.0.1.evil.example",
                           "[evil]", "[", "desk.evil.example", "localhost.evil.example"}) {
    EXPECT_FALSE(is_own_host(host, "desk", "127.0.0.1")) << host;
  }
  EXPECT_FALSE(is_own_host("", "", ""));
}

TEST(OwnHost, IsTheNameThatTheUserHasGiven) {
  EXPECT_TRUE(is_own_host("desk.example.org:8787", "desk", "desk.example.org"));
  EXPECT_TRUE(is_own_host("desk.example.org", "desk", "Desk.Example.org"));
  EXPECT_TRUE(is_own_host("desk", "desk", "desk.example.org"));
  EXPECT_FALSE(is_own_host("evil.example:8787", "desk", "desk.example.org"));
  EXPECT_FALSE(is_own_host("", "desk", ""));
}

TEST_F(AccessTest, OnlyThePageNeedsNoLogin) {
  EXPECT_EQ(status_of(get("/")), 200);
  EXPECT_EQ(status_of(get("/style.css")), 200);
  EXPECT_FALSE(message<web::LoginState>(get("/api/login")).logged_in());
  for (const char* path : {"/api/farm", "/api/jobs/1", "/api/gallery", "/metrics", "/api/nothing",
                           "/api/jobs/1/preview.png", "/api/workers/log?name=a"}) {
    EXPECT_EQ(status_of(get(path)), 401) << path;
  }
  for (const char* path : {"/api/jobs/1/cancel", "/api/scenes?name=a.glb", "/api/gallery/render"}) {
    EXPECT_EQ(status_of(post(path)), 401) << path;
  }
}

TEST_F(AccessTest, TheSecretOrTheJoinStringLogsIn) {
  log_in();
  EXPECT_EQ(status_of(get("/api/farm")), 200);
  EXPECT_TRUE(message<web::LoginState>(get("/api/login")).logged_in());
  link::JoinString join;
  join.role = link::Role::kFarm;
  join.addresses = {"127.0.0.1:7878"};
  join.secret = identity_.farm_secret;
  const auto result = post("/api/login", "{\"secret\": \" " + join.text() + "\\n\"}");
  EXPECT_EQ(status_of(result), 200);
  const std::string cookie = result->header("Set-Cookie");
  EXPECT_NE(cookie.find("HttpOnly"), std::string::npos);
  EXPECT_NE(cookie.find("SameSite=Strict"), std::string::npos);
  EXPECT_EQ(cookie.find(identity_.farm_secret), std::string::npos);
}

TEST_F(AccessTest, AWrongSecretAndTheWorkersSecretDoNotLogIn) {
  EXPECT_EQ(status_of(post("/api/login", "{\"secret\": \"wrong\"}")), 401);
  EXPECT_EQ(status_of(post("/api/login", "{\"secret\": \"" + identity_.worker_secret + "\"}")),
            403);
  EXPECT_EQ(status_of(post("/api/login", "no json")), 400);
  headers_.emplace("Cookie",
                   "bandsaw-" + std::to_string(dashboard_->port()) + "=" + std::string(64, '0'));
  EXPECT_EQ(status_of(get("/api/farm")), 401);
}

TEST_F(AccessTest, ManyWrongSecretsAreLimited) {
  Access access(identity_, /*secure=*/false, "127.0.0.1");
  HttpRequest request;
  request.remote_address = "10.0.0.7";
  HttpReply reply;
  for (std::size_t i = 0; i < wire::kWrongSecretsPerMinute; ++i) {
    ASSERT_TRUE(absl::IsUnauthenticated(access.log_in(request, "wrong", reply)));
  }
  EXPECT_TRUE(absl::IsResourceExhausted(access.log_in(request, "wrong", reply)));
  // The right secret is still accepted, because many users may share this address.
  EXPECT_TRUE(access.log_in(request, identity_.farm_secret, reply).ok());
}

TEST_F(AccessTest, ProgramsSendTheSecretItself) {
  headers_.emplace("Authorization", "Bearer " + identity_.farm_secret);
  const auto result = get("/metrics");
  EXPECT_EQ(status_of(result), 200);
  EXPECT_NE(result->body.find("bandsaw_jobs{state=\"running\"} 0\n"), std::string::npos);
}

TEST_F(AccessTest, OtherSitesCannotAct) {
  log_in();
  headers_.emplace("Origin", "http://evil.example");
  EXPECT_EQ(status_of(post("/api/jobs/1/cancel")), 403);
  headers_.erase("Origin");
  headers_.emplace("Origin", base());
  EXPECT_EQ(status_of(post("/api/jobs/1/cancel")), 404);
  headers_.erase("X-Bandsaw");
  EXPECT_EQ(status_of(post("/api/jobs/1/cancel")), 403);
}

TEST_F(AccessTest, AForeignNameForThisMachineIsRefused) {
  headers_.emplace("Host", "evil.example");
  EXPECT_EQ(status_of(get("/")), 403);
}

TEST_F(AccessTest, TheNameThatTheDashboardListensOnIsAccepted) {
  Access access(identity_, /*secure=*/true, "desk.example.org");
  HttpRequest request;
  request.method = "GET";
  request.path = "/";
  request.headers = {{"Host", "desk.example.org:8787"}};
  EXPECT_TRUE(access.check(request).ok());
  request.headers = {{"Host", "evil.example:8787"}};
  EXPECT_TRUE(absl::IsPermissionDenied(access.check(request)));
}

TEST_F(AccessTest, ANewSecretInvalidatesLogins) {
  log_in();
  link::Identity renewed = identity_;
  renewed.farm_secret = "another22characters000";
  dashboard_->renew(renewed);
  EXPECT_EQ(status_of(get("/api/farm")), 401);
}

// An upload begins after a login with the old secret of the users. When this secret is replaced,
// the server closes the upload's connection without a response.
TEST_F(AccessTest, ANewSecretClosesConnections) {
  log_in();
  const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(dashboard_->port()));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  ASSERT_EQ(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  const std::string head =
      "POST /api/scenes?name=a.glb HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Bandsaw: 1\r\nCookie: " +
      headers_.find("Cookie")->second + "\r\nExpect: 100-continue\r\nContent-Length: 1000\r\n\r\n";
  ASSERT_EQ(send(client, head.data(), head.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(head.size()));
  // The response "HTTP/1.1 100 Continue" with its empty line has 25 bytes: the request is admitted.
  std::string received(25, '\0');
  ASSERT_EQ(recv(client, received.data(), received.size(), MSG_WAITALL), 25);
  ASSERT_EQ(received.substr(0, 12), "HTTP/1.1 100");
  link::Identity renewed = identity_;
  renewed.worker_secret = "another22characters000";
  dashboard_->renew(renewed);
  char answer = 0;
  EXPECT_EQ(recv(client, &answer, 1, MSG_DONTWAIT), -1)
      << "a new secret of the workers must not close the connection";
  renewed.farm_secret = "another22characters000";
  dashboard_->renew(renewed);
  EXPECT_EQ(recv(client, &answer, 1, 0), 0) << answer;
  close(client);
}

// A half-open connection occupies a thread of the server until the deadline of the connection. The
// server has 32 threads. 40 such connections would occupy all threads if the number of connections
// of one address were not limited.
TEST_F(AccessTest, HalfOpenConnectionsOfOneAddressDoNotBlockOthers) {
  std::vector<int> sockets;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(dashboard_->port()));
  inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
  for (int i = 0; i < 40; ++i) {
    const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in from{};
    from.sin_family = AF_INET;
    inet_pton(AF_INET, "127.0.0.2", &from.sin_addr);
    ASSERT_EQ(bind(client, reinterpret_cast<sockaddr*>(&from), sizeof(from)), 0);
    ASSERT_EQ(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    send(client, "GET / HT", 8, MSG_NOSIGNAL);  // fails if the server has closed the connection
    sockets.push_back(client);
  }
  EXPECT_EQ(status_of(get("/")), 200);
  for (const int client : sockets) {
    close(client);
  }
}

// Without a login, the server responds to the head of the request, and never reads the body.
TEST_F(AccessTest, ABodyForAnUnknownPathIsNotRead) {
  for (const std::string path : {"/nowhere", "/%0A"}) {
    const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(dashboard_->port()));
    inet_pton(AF_INET, "127.0.0.1", &address.sin_addr);
    ASSERT_EQ(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    const std::string head = "POST " + path +
                             " HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Bandsaw: 1\r\nContent-Length: "
                             "1000000000000\r\n\r\n";
    ASSERT_EQ(send(client, head.data(), head.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(head.size()));
    char answer[13] = {};
    ASSERT_EQ(recv(client, answer, sizeof(answer) - 1, MSG_WAITALL), 12);
    EXPECT_STREQ(answer, "HTTP/1.1 404");
    close(client);
  }
}

TEST_F(AccessTest, AHeadThatIsTooLongIsRefused) {
  headers_.emplace("X-Long", std::string(4000, 'x'));
  EXPECT_EQ(status_of(get("/")), 200);
  for (int i = 0; i < 20; ++i) {  // 80 kB in all; a head may have 32 KiB
    headers_.emplace("X-Long-" + std::to_string(i), std::string(4000, 'x'));
  }
  EXPECT_NE(status_of(get("/")), 200);
}

}  // namespace
}  // namespace bandsaw::coordinator
