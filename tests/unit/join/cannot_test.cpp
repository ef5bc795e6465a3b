// The limits of somebody who has the link for browsers. The name of each test completes the
// sentence "the holder of the link cannot …", and there is one test for each line of the table in
// coordinator/web/README.md.

#include <gmock/gmock.h>

#include <thread>

#include "absl/strings/escaping.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/rpc/server.h"
#include "proto/farm.grpc.pb.h"
#include "proto/link/channel.h"
#include "proto/wire/limits.h"
#include "tests/unit/join/join_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class JoinCannotTest : public JoinTest {
 protected:
  /// Tries to open a session with this offer. Returns the HTTP status of the refusal.
  int refused(test::SocketOffer offer) const {
    return test::SocketClient(dashboard_->port(), offer).status();
  }
};

// ---- Rights of users and workers ----

TEST_F(JoinCannotTest, UseTheDashboard) {
  for (const char* path :
       {"/api/farm", "/api/jobs/1", "/api/jobs/1/image.png", "/api/jobs/1/preview.png",
        "/api/jobs/1/frames", "/api/gallery", "/metrics", "/api/workers/log?name=desk", "/api/link",
        "/api/link.svg"}) {
    const auto got = join_get(path);
    ASSERT_TRUE(got) << path;
    EXPECT_EQ(got->status, 401) << path;
  }
  for (const char* path :
       {"/api/scenes?name=a.glb", "/api/jobs/1/cancel", "/api/jobs/1/pause", "/api/jobs/1/priority",
        "/api/gallery/render", "/api/files", "/api/link", "/api/link/revoke"}) {
    const auto got = join_post(path, "{}");
    ASSERT_TRUE(got) << path;
    EXPECT_EQ(got->status, 401) << path;
  }
  EXPECT_EQ(join_post("/api/login", "{\"secret\": \"" + secret_ + "\"}")->status, 401);
}

TEST_F(JoinCannotTest, CallAnythingByGrpc) {
  const auto server =
      Server::start(*engine_, identity_, {.listen = "127.0.0.1:0", .browsers = access_.get()});
  ASSERT_TRUE(server.ok()) << server.status();
  link::JoinString join;
  join.role = link::Role::kWorker;
  join.addresses = {"127.0.0.1:" + std::to_string((*server)->port())};
  join.certificate = identity_.certificate_digest;
  join.secret = secret_;
  const auto connected = link::connect(join, std::chrono::seconds(60));
  ASSERT_TRUE(connected.ok());
  const auto farm = farm::Farm::NewStub(connected->control);
  const auto work = farm::Work::NewStub(connected->control);
  const auto call = [&](auto make) {
    grpc::ClientContext context;
    link::prepare(context, join, std::chrono::seconds(60));
    EXPECT_EQ(make(&context).error_code(), grpc::StatusCode::UNAUTHENTICATED);
  };
  call([&](grpc::ClientContext* c) {
    farm::SubmitReply r;
    return farm->Submit(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::ListJobsReply r;
    return farm->ListJobs(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::ListWorkersReply r;
    return farm->ListWorkers(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::JobStatus r;
    return farm->Cancel(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::LogsReply r;
    return farm->Logs(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::AboutReply r;
    return farm->About(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::RotateSecretReply r;
    return farm->RotateSecret(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) {
    farm::BrowserLinkReply r;
    return farm->BrowserLink(c, {}, &r);
  });
  call([&](grpc::ClientContext* c) { return farm->Watch(c, farm::WatchRequest())->Finish(); });
  call([&](grpc::ClientContext* c) {
    return farm->GetResult(c, farm::GetResultRequest())->Finish();
  });
  call([&](grpc::ClientContext* c) { return work->Session(c)->Finish(); });
  call([&](grpc::ClientContext* c) { return work->PutBands(c)->Finish(); });
  call([&](grpc::ClientContext* c) { return work->GetBlob(c, farm::GetBlobRequest())->Finish(); });
}

TEST_F(JoinCannotTest, FindASecretInWhatIsPublic) {
  for (const char* path : {"/join", "/join.js", "/join/bandsaw.wasm", "/join/about"}) {
    const auto got = join_get(path);
    ASSERT_TRUE(got) << path;
    EXPECT_EQ(got->status, 200) << path;
    for (const std::string& secret : {secret_, identity_.worker_secret, identity_.farm_secret}) {
      EXPECT_THAT(got->body, Not(HasSubstr(secret))) << path;
    }
  }
}

// ---- Blobs and bands ----
//
// A scene is stored as blobs: the manifest, and the blobs that the manifest names. A lease gives a
// tab a band to render. A band is a range of rows and a range of samples of these rows.

TEST_F(JoinCannotTest, ReadBlobsBeforeASceneIsLeased) {
  log_in();
  submit_box();
  const auto job = message<web::JobPage>(get("/api/jobs/1"));
  const std::string manifest = absl::BytesToHexString(job.job().status().manifest_sha256());
  EXPECT_EQ(join_get("/join/blob/" + manifest)->status, 404);
  test::SocketClient socket = open();
  lease_to(socket);
  EXPECT_EQ(join_get("/join/blob/" + manifest)->status, 200);
}

TEST_F(JoinCannotTest, ReadBlobsOfJobsThatAreOver) {
  log_in();
  submit_box();
  test::SocketClient socket = open();
  const std::string manifest = absl::BytesToHexString(lease_to(socket).manifest_sha256());
  ASSERT_EQ(join_get("/join/blob/" + manifest)->status, 200);
  ASSERT_EQ(post("/api/jobs/1/cancel")->status, 200);
  EXPECT_EQ(join_get("/join/blob/" + manifest)->status, 404);
}

TEST_F(JoinCannotTest, ReadFilesByName) {
  for (const char* name : {"..%2Fidentity", "identity", "0123", "%00"}) {
    EXPECT_EQ(join_get(std::string("/join/blob/") + name)->status, 404) << name;
  }
}

TEST_F(JoinCannotTest, SendBandsThatWereNotLeased) {
  log_in();
  submit_box();
  test::SocketClient socket = open();
  const farm::Lease lease = lease_to(socket);
  farm::Lease other = lease;
  other.set_job(2);
  EXPECT_EQ(join_post("/join/band", band(other))->status, 403);
  other = lease;
  other.mutable_band()->set_first_sample(lease.band().last_sample());
  other.mutable_band()->set_last_sample(2 * lease.band().last_sample());
  EXPECT_EQ(join_post("/join/band", band(other))->status, 403);
  other = lease;
  other.mutable_band()->set_last_row(lease.band().last_row() + 1);
  EXPECT_EQ(join_post("/join/band", band(other))->status, 403);
  EXPECT_EQ(join_post("/join/band", band(lease, "stranger"))->status, 403);
  EXPECT_EQ(join_post("/join/band", band(lease))->status, 200);
}

TEST_F(JoinCannotTest, SendBandsThatAreDamagedOrTooLong) {
  log_in();
  submit_box();
  test::SocketClient socket = open();
  const std::string whole = band(lease_to(socket));
  std::string other = whole;
  other.back() = static_cast<char>(other.back() ^ 1);  // so its digest is wrong
  EXPECT_EQ(join_post("/join/band", other)->status, 400);
  EXPECT_EQ(join_post("/join/band", whole.substr(0, whole.size() - 8))->status, 400);
  EXPECT_EQ(join_post("/join/band", whole + "more")->status, 400);
  EXPECT_EQ(join_post("/join/band", "")->status, 400);
  // The body begins with the length of the band's header, in four bytes.
  EXPECT_EQ(join_post("/join/band", "\xff\xff\xff\xff" + whole)->status, 400);
  EXPECT_EQ(join_post("/join/band", std::string("\x04\0\0\0", 4) + "\xff\xff\xff\xff")->status,
            400);
}

// ---- The link ----

TEST_F(JoinCannotTest, JoinWithoutTheSecret) {
  EXPECT_EQ(refused({.secret = ""}), 401);
  EXPECT_EQ(refused({.secret = std::string(22, 'x')}), 401);
  EXPECT_EQ(refused({.secret = identity_.worker_secret}), 401);
  EXPECT_EQ(refused({.secret = identity_.farm_secret}), 401);
  EXPECT_EQ(refused({.secret = secret_, .protocol = "bandsaw.2"}), 401);
  secret_ = std::string(22, 'x');
  EXPECT_EQ(join_get("/join/about")->status, 401);
  EXPECT_EQ(join_get("/join/blob/" + std::string(64, '0'))->status, 401);
  const auto refusal = join_post("/join/band", "");
  EXPECT_EQ(refusal->status, 401);
  EXPECT_THAT(message<web::Problem>(refusal).error(), HasSubstr("bandsaw link"));
}

TEST_F(JoinCannotTest, GuessManyTimes) {
  secret_ = std::string(22, 'x');
  for (std::size_t i = 0; i < wire::kWrongSecretsPerMinute; ++i) {
    ASSERT_TRUE(absl::IsUnauthenticated(access_->check(secret_, "127.0.0.1")));
  }
  EXPECT_EQ(join_get("/join/about")->status, 429);
}

TEST_F(JoinCannotTest, GoOnAfterTheLinkIsRevoked) {
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  ASSERT_TRUE(socket.read());
  EXPECT_EQ(join_get("/join/about")->status, 200);
  log_in();
  EXPECT_EQ(post("/api/link/revoke")->status, 200);
  EXPECT_EQ(join_get("/join/about")->status, 401);
  EXPECT_EQ(join_post("/join/band", "")->status, 401);
  EXPECT_EQ(refused({.secret = secret_}), 401);
  socket.read_to_end();
  EXPECT_EQ(socket.close_code(), 4401);  // bandsaw's own code: the link has ended or was revoked
  EXPECT_THAT(socket.close_reason(), HasSubstr("revoked"));
  wait_until([&] { return workers().empty(); });
}

TEST_F(JoinCannotTest, GoOnAfterTheLinkHasEnded) {
  test::SocketClient socket = open();
  ASSERT_TRUE(access_->make(1).ok());  // the link ends in a second
  socket.read_to_end();
  EXPECT_EQ(socket.close_code(), 4401);
  EXPECT_EQ(join_get("/join/about")->status, 401);
}

// ---- Other sites ----

TEST_F(JoinCannotTest, ComeFromAnotherSite) {
  EXPECT_EQ(refused({.secret = secret_, .origin = "https://evil.example"}), 403);
  EXPECT_EQ(refused({.secret = secret_, .origin = "null"}), 403);
  const std::string origin = "https://evil.example";
  const auto got = test::http_call(
      dashboard_->port(),
      {.method = "POST",
       .target = "/join/band",
       .headers = {
           {"Authorization", "Bearer " + secret_}, {"X-Bandsaw", "1"}, {"Origin", origin}}});
  EXPECT_EQ(got->status, 403);
  const auto bare =
      test::http_call(dashboard_->port(), {.method = "POST",
                                           .target = "/join/band",
                                           .headers = {{"Authorization", "Bearer " + secret_}}});
  EXPECT_EQ(bare->status, 403);
  // A request without an Origin does not come from a browser's WebSocket.
  const auto plain = test::http_call(
      dashboard_->port(),
      {.target = "/join/session",
       .headers = {{"Sec-WebSocket-Protocol", "bandsaw.1, bandsaw.secret." + secret_}}});
  EXPECT_EQ(plain->status, 403);
}

// ---- Resources ----

TEST_F(JoinCannotTest, SendLongMessages) {
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  socket.send_bytes(std::string(100'000, 'x'));
  socket.read_to_end();
  EXPECT_EQ(socket.close_code(), 1009);  // "message too big" of the WebSocket standard
  wait_until([&] { return workers().empty(); });
}

TEST_F(JoinCannotTest, OpenMoreSocketsThanAreAllowed) {
  options_.browser_limits.sockets = 2;
  start_dashboard();
  test::SocketClient first = open();
  {
    test::SocketClient second = open();
    test::SocketClient third = open();
    EXPECT_EQ(third.status(), 503);
    EXPECT_THAT(third.refusal(), HasSubstr("2 browsers are connected"));
    second.close();
  }
  wait_until([&] { return open().status() == 101; });  // the second tab's place is free again
}

TEST_F(JoinCannotTest, HoldASocketWithoutAHandshake) {
  options_.browser_limits.handshake = std::chrono::milliseconds(100);
  start_dashboard();
  const std::string host = "127.0.0.1:" + std::to_string(dashboard_->port());
  // A request that asks for a session but is no WebSocket handshake.
  const std::string answer = test::send_bytes_to(
      dashboard_->port(), "GET /join/session HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" +
                              host + "\r\nSec-WebSocket-Protocol: bandsaw.1, bandsaw.secret." +
                              secret_ + "\r\n\r\n");
  EXPECT_THAT(answer, testing::StartsWith("HTTP/1.1 4"));
}

// Either the coordinator's messages for this tab fill the tab's queue, or a message is not sent in
// time. In both cases the tab's session ends, and the scheduler is not blocked.
TEST_F(JoinCannotTest, HoldUpTheFarmByNotReading) {
  options_.browser_limits.write = std::chrono::milliseconds(200);
  options_.browser_limits.idle = std::chrono::minutes(1);
  options_.browser_limits.send_buffer = 4096;
  start_dashboard();
  test::SocketClient socket(dashboard_->port(), {.secret = secret_}, /*receive_buffer=*/2048);
  farm::FromWorker message = hello();
  message.mutable_hello()->set_max_bands(16);
  ASSERT_TRUE(socket.send(message));
  log_in();
  wait_until([&] { return !workers().empty(); });
  send_until_nobody_is_connected();
}

}  // namespace
}  // namespace bandsaw::coordinator
