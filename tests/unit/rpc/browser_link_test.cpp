// The link by which browsers join the farm as workers. The call BrowserLink makes the link, shows
// it, changes the time at which it ends, or revokes it. A file keeps the link over a restart.

#include <gmock/gmock.h>

#include <fstream>

#include "coordinator/rpc/browser_access.h"
#include "tests/unit/rpc/farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class BrowserLinkTest : public FarmTest {
 protected:
  BrowserLinkTest() { start(); }

  /// Loads the link as a coordinator does when it is started, and starts a server.
  void start() {
    server_.reset();
    auto access = BrowserAccess::load(folder_ / "identity", [this] { return now_; });
    ASSERT_TRUE(access.ok()) << access.status();
    access_ = *std::move(access);
    access_->set_address("https://10.0.0.5:8787");
    auto server =
        Server::start(*engine_, identity_, {.listen = "127.0.0.1:0", .browsers = access_.get()});
    ASSERT_TRUE(server.ok()) << server.status();
    server_ = *std::move(server);
    channel_ = link::connect(join(link::Role::kFarm), std::chrono::seconds(60))->control;
  }
  ~BrowserLinkTest() override { server_.reset(); }

  /// Calls BrowserLink and keeps its status. `seconds`: the time until the link is to end. If
  /// `seconds` is 0, the end of an existing link is not changed, and a new link gets the standard
  /// duration.
  farm::BrowserLinkReply ask(double seconds = 0, bool revoke = false) {
    farm::BrowserLinkRequest request;
    request.set_seconds(seconds);
    request.set_revoke(revoke);
    farm::BrowserLinkReply reply;
    status_ = people()->BrowserLink(context(link::Role::kFarm).get(), request, &reply);
    return reply;
  }
  /// Returns true if browsers can join by this URL now.
  bool holds(const std::string& url) { return access_->holds(url.substr(url.find('#') + 1)); }

  double now_ = 1'700'000'000;  ///< seconds since 1970, by the clock of the link
  grpc::Status status_;
  std::unique_ptr<BrowserAccess> access_;
};

TEST_F(BrowserLinkTest, IsMadeOnceAndThenShown) {
  const farm::BrowserLinkReply made = ask();
  EXPECT_THAT(made.url(), StartsWith("https://10.0.0.5:8787/join#"));
  // A secret has 22 characters.
  EXPECT_EQ(made.url().size(), std::string("https://10.0.0.5:8787/join#").size() + 22);
  EXPECT_EQ(made.left_s(), BrowserAccess::kStandardSeconds);
  now_ += 100;
  const farm::BrowserLinkReply shown = ask();
  EXPECT_EQ(shown.url(), made.url());
  EXPECT_EQ(shown.left_s(), BrowserAccess::kStandardSeconds - 100);
}

TEST_F(BrowserLinkTest, EndsAtItsTime) {
  const std::string url = ask(100).url();
  now_ += 99;
  EXPECT_TRUE(holds(url));
  now_ += 1;
  EXPECT_FALSE(holds(url));
  EXPECT_NE(ask().url(), url) << "a link that has ended does not come back";
}

TEST_F(BrowserLinkTest, KeepsItsSecretWhenItsEndIsMoved) {
  const std::string url = ask(100).url();
  EXPECT_EQ(ask(1000).url(), url);
  now_ += 500;
  EXPECT_TRUE(holds(url));
  EXPECT_EQ(ask(10).url(), url);
  now_ += 11;
  EXPECT_FALSE(holds(url));
}

TEST_F(BrowserLinkTest, IsKeptOverARestart) {
  const std::string url = ask(1000).url();
  start();
  EXPECT_TRUE(holds(url));
  EXPECT_EQ(ask().url(), url);
  now_ += 1000;
  start();
  EXPECT_FALSE(holds(url));
}

TEST_F(BrowserLinkTest, IsRevoked) {
  const std::string url = ask().url();
  EXPECT_EQ(ask(/*seconds=*/0, /*revoke=*/true).url(), "");
  EXPECT_TRUE(status_.ok()) << status_.error_message();
  EXPECT_FALSE(holds(url));
  EXPECT_EQ(ask(/*seconds=*/0, /*revoke=*/true).url(), "")
      << "a second revocation gives the same answer";
  start();
  EXPECT_FALSE(holds(url)) << "a revoked link must stay invalid after a restart";
  EXPECT_NE(ask().url(), url);
}

TEST_F(BrowserLinkTest, RefusesInvalidAndForbiddenRequests) {
  ask(0.5);
  EXPECT_EQ(status_.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  ask(BrowserAccess::kMaxSeconds + 1);
  EXPECT_EQ(status_.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  ask(std::nan(""));
  EXPECT_EQ(status_.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  ask(/*seconds=*/10, /*revoke=*/true);
  EXPECT_EQ(status_.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  access_->set_address("");  // as without the option --web
  ask();
  EXPECT_EQ(status_.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_THAT(status_.error_message(), HasSubstr("--web"));
  farm::BrowserLinkReply reply;
  EXPECT_EQ(people()->BrowserLink(context(link::Role::kWorker).get(), {}, &reply).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
}

TEST_F(BrowserLinkTest, TheErrorOfADamagedFileNamesACommandThatHelps) {
  ask();
  for (const char* text : {"", "something\n", "bandsaw-browsers 1\nsecret short\nends 1\n",
                           "bandsaw-browsers 1\nsecret 0123456789abcdefghijkl\nends soon\n"}) {
    std::ofstream(folder_ / "identity/browsers") << text;
    const auto loaded = BrowserAccess::load(folder_ / "identity");
    EXPECT_TRUE(absl::IsDataLoss(loaded.status())) << text;
    EXPECT_THAT(std::string(loaded.status().message()), HasSubstr("bandsaw link"));
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
