// A browser's session over a WebSocket, from its first message, Hello, to the last band, and every
// way in which a session ends. Close codes of the standard are 1000 (normal), 1001 (going away) and
// 1008 (violation of the rules). The close code 4409 is bandsaw's own: another session of the same
// tab replaced this one.

#include <gmock/gmock.h>

#include <thread>

#include "absl/strings/escaping.h"
#include "tests/unit/join/join_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class JoinSessionTest : public JoinTest {};

TEST_F(JoinSessionTest, ABrowserRendersAJob) {
  log_in();
  const std::uint64_t job = submit_box();
  test::SocketClient socket = open();
  EXPECT_EQ(socket.protocol(), "bandsaw.1");
  farm::Lease lease = lease_to(socket);
  EXPECT_EQ(lease.job(), job);
  const std::string manifest = absl::BytesToHexString(lease.manifest_sha256());
  EXPECT_EQ(join_get("/join/blob/" + manifest)->status, 200);
  for (bool is_done = false; !is_done;) {
    const auto put = join_post("/join/band", band(lease));
    ASSERT_TRUE(put);
    ASSERT_EQ(put->status, 200) << put->body;
    farm::PutBandReply reply;
    ASSERT_TRUE(reply.ParseFromString(put->body));
    EXPECT_EQ(reply.outcome(), farm::PutBandReply::OUTCOME_STORED);
    const auto page = message<web::JobPage>(get("/api/jobs/" + std::to_string(job)));
    is_done = page.job().status().fraction() == 1;
    while (!is_done) {
      const auto next = socket.read();
      ASSERT_TRUE(next) << socket.close_reason();
      if (next->has_lease()) {
        lease = next->lease();
        break;
      }
    }
  }
}

TEST_F(JoinSessionTest, TheFarmListsABrowserWhileItIsConnected) {
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  ASSERT_TRUE(socket.read()->has_welcome());
  EXPECT_THAT(workers(), ElementsAre(HasSubstr("tab")));
  log_in();
  EXPECT_TRUE(message<web::Overview>(get("/api/farm")).worker(0).browser());
  socket.close();
  wait_until([&] { return workers().empty(); });
}

TEST_F(JoinSessionTest, ATabThatVanishesIsLost) {
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  ASSERT_TRUE(socket.read());
  socket.vanish();
  wait_until([&] { return workers().empty(); });
}

// A frozen machine closes no connection, so the coordinator must notice that pings are not
// answered.
TEST_F(JoinSessionTest, ATabThatNoLongerAnswersIsLost) {
  options_.browser_limits.idle = std::chrono::milliseconds(600);
  start_dashboard();
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  ASSERT_TRUE(socket.read());  // the tab reads nothing more, so it answers no ping
  EXPECT_THAT(workers(), Not(IsEmpty()));
  wait_until([&] { return workers().empty(); });
}

TEST_F(JoinSessionTest, ATabThatAnswersPingsStays) {
  options_.browser_limits.idle = std::chrono::milliseconds(600);
  start_dashboard();
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  ASSERT_TRUE(socket.read());
  // Reading answers the pings. Nothing else comes until the coordinator stops.
  std::thread reader([&] { socket.read_to_end(); });
  // A ping is sent after half of the limit, so four pings take twice the limit.
  wait_until([&] { return socket.pings() == 4; });
  EXPECT_THAT(workers(), Not(IsEmpty()));
  dashboard_.reset();
  reader.join();
  EXPECT_EQ(socket.close_code(), 1001);
}

TEST_F(JoinSessionTest, AViolationEndsTheSessionWithTheReason) {
  farm::FromWorker beat;
  beat.mutable_heartbeat();
  farm::FromWorker bad = hello();
  bad.mutable_hello()->set_threads(0);
  const std::vector<std::pair<std::string, const char*>> cases = {
      {beat.SerializeAsString(), "hello"},
      {bad.SerializeAsString(), "hello.threads"},
      {"no message of protobuf", "binary"},
  };
  for (const auto& [bytes, reason] : cases) {
    test::SocketClient socket = open();
    socket.send_bytes(bytes);
    socket.read_to_end();
    EXPECT_EQ(socket.close_code(), 1008) << reason;
    EXPECT_THAT(socket.close_reason(), HasSubstr(reason));
  }
  test::SocketClient text = open();
  text.send_bytes("hello", /*binary=*/false);
  text.read_to_end();
  EXPECT_EQ(text.close_code(), 1008);
  test::SocketClient twice = open();
  twice.send(hello());
  twice.send(hello());
  twice.read_to_end();
  EXPECT_EQ(twice.close_code(), 1008);
  test::SocketClient raw = open();
  raw.send_raw(std::string(100, '\xff'));
  raw.read_to_end();
  EXPECT_NE(raw.close_code(), 1000);
}

TEST_F(JoinSessionTest, ABrowserThatRendersOtherPixelsIsRefused) {
  test::SocketClient socket = open();
  farm::FromWorker other = hello();
  other.mutable_hello()->set_canary(other.hello().canary() + 1);
  ASSERT_TRUE(socket.send(other));
  const auto answer = socket.read();
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->refused().reason().empty());
  socket.read_to_end();
  EXPECT_EQ(socket.close_code(), 1000);
}

TEST_F(JoinSessionTest, ASecondSessionOfATabEndsItsFirst) {
  test::SocketClient first = open();
  ASSERT_TRUE(first.send(hello()));
  ASSERT_TRUE(first.read());
  test::SocketClient second = open();  // the same tab, which has connected again
  ASSERT_TRUE(second.send(hello()));
  ASSERT_TRUE(second.read());
  first.read_to_end();
  EXPECT_EQ(first.close_code(), 4409);
  EXPECT_FALSE(first.close_reason().empty());
}

TEST_F(JoinSessionTest, AStoppingCoordinatorClosesSessionsAsGoingAway) {
  test::SocketClient greeted = open();
  ASSERT_TRUE(greeted.send(hello()));
  ASSERT_TRUE(greeted.read());
  test::SocketClient silent = open();
  std::thread stop([&] { dashboard_.reset(); });
  greeted.read_to_end();
  silent.read_to_end();
  stop.join();
  EXPECT_EQ(greeted.close_code(), 1001);
  EXPECT_EQ(silent.close_code(), 1001);
}

TEST_F(JoinSessionTest, ATabThatIgnoresTheCloseFrameDoesNotHoldUpTheCoordinator) {
  options_.browser_limits.stop = std::chrono::milliseconds(50);
  start_dashboard();
  test::SocketClient socket = open();
  ASSERT_TRUE(socket.send(hello()));
  dashboard_.reset();  // returns, although nobody reads the close frame
}

TEST_F(JoinSessionTest, ManySessionsDoNotUseUpTheThreadsOfTheDashboard) {
  std::vector<std::unique_ptr<test::SocketClient>> sockets;
  for (int i = 0; i < 64; ++i) {  // twice as many as the HTTP server has threads
    sockets.push_back(std::make_unique<test::SocketClient>(dashboard_->port(),
                                                           test::SocketOffer{.secret = secret_}));
    ASSERT_EQ(sockets.back()->status(), 101);
    ASSERT_TRUE(sockets.back()->send(hello("tab " + std::to_string(i))));
    ASSERT_TRUE(sockets.back()->read());
  }
  EXPECT_EQ(workers().size(), 64U);
  EXPECT_EQ(get("/")->status, 200);
}

}  // namespace
}  // namespace bandsaw::coordinator
