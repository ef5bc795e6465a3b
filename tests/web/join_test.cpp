// Browsers as workers of a farm: a job has the same bytes as a local render, whatever their tabs
// do.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <filesystem>
#include <fstream>
#include <memory>

#include "absl/strings/str_cat.h"
#include "tests/farm/farm_processes.h"
#include "tests/web/browser.h"
#include "tests/web/firefox.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

/// Returns the processes that descend from `parent`, and itself.
std::vector<pid_t> family(pid_t parent) {
  std::multimap<pid_t, pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::string stat;
    std::getline(std::ifstream(entry.path() / "stat"), stat);
    const std::size_t after_name = stat.rfind(')');
    if (after_name != std::string::npos) {
      children.emplace(std::atoi(stat.c_str() + after_name + 4), std::atoi(stat.c_str()));
    }
  }
  std::vector<pid_t> found = {parent};
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto [first, last] = children.equal_range(found[i]);
    for (auto child = first; child != last; ++child) {
      found.push_back(child->second);
    }
  }
  return found;
}

void signal_all(const std::vector<pid_t>& processes, int number) {
  for (const pid_t process : processes) {
    kill(process, number);
  }
}

/// Returns a port of loopback that nobody uses now.
int free_port() {
  boost::asio::io_context context;
  using boost::asio::ip::tcp;
  const tcp::acceptor acceptor(context, {boost::asio::ip::address_v4::loopback(), 0});
  return acceptor.local_endpoint().port();
}

std::string program_of(const Browser*) { return chromedriver_program(); }
std::string program_of(const Firefox*) { return firefox_program(); }

/// A farm, and tabs of one kind of browser.
template <class Kind>
class JoinTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (program_of(static_cast<const Kind*>(nullptr)).empty()) {
      GTEST_SKIP() << "the browser is not installed (deploy/install.sh browser)";
    }
    if (!fs::exists(BANDSAW_WASM)) {
      GTEST_SKIP() << BANDSAW_WASM << " does not exist: run deploy/wasm.sh";
    }
    farm_.emplace(nullptr,
                  std::vector<std::string>{"--audit", "0%", "--browser-audit", "0%", "--web",
                                           absl::StrCat("127.0.0.1:", free_port())});
    const Finished made = run(farm_->command({"link", "--json"}));
    ASSERT_EQ(made.code, 0) << made.err;
    google::protobuf::Struct link;
    ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(made.out, &link).ok()) << made.out;
    link_ = link.fields().at("url").string_value();
  }

  /// Opens the link, and starts with `cores` cores.
  std::unique_ptr<Kind> open(int cores) {
    auto tab = std::make_unique<Kind>();
    tab->go(link_);
    start(*tab, cores);
    return tab;
  }
  static void start(Kind& tab, int cores) {
    ASSERT_TRUE(tab.wait("document.querySelector('#start')?.offsetParent"));
    tab.run(absl::StrCat("document.querySelector('#cores').value = ", cores,
                         "; document.querySelector('#start').click();"));
    ASSERT_TRUE(
        tab.wait("['waiting', 'loading', 'rendering'].includes(document.body.dataset.phase)"))
        << tab.text("document.body.innerText");
  }
  static bool has_rendered(Kind& tab) { return tab.wait("Number(document.body.dataset.rows) > 0"); }

  std::vector<std::string> settings(const std::string& scene, const std::string& samples) const {
    return {std::string(BANDSAW_GALLERY) + "/" + scene + ".textproto",
            "--width",
            "96",
            "--samples",
            samples,
            "--quiet"};
  }
  Process submit(const std::vector<std::string>& what) {
    std::vector<std::string> arguments = {"submit"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    arguments.insert(arguments.end(), {"-o", farm_->path("farm.pfm")});
    return Process::start(farm_->command(arguments));
  }
  void expect_same_bytes(Process& client, const std::vector<std::string>& what) {
    ASSERT_EQ(client.wait(), 0) << client.err() << farm_->coordinator_log();
    std::vector<std::string> arguments = {BANDSAW_BIN, "render"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    arguments.insert(arguments.end(), {"-o", farm_->path("here.pfm")});
    expect_success(run(arguments));
    EXPECT_TRUE(file_bytes(farm_->path("farm.pfm")) == file_bytes(farm_->path("here.pfm")));
  }

  std::optional<FarmProcesses> farm_;
  std::string link_;
};

using Kinds = ::testing::Types<Browser, Firefox>;
struct KindName {
  template <class Kind>
  static std::string GetName(int) {
    return std::is_same_v<Kind, Browser> ? "Chromium" : "Firefox";
  }
};
TYPED_TEST_SUITE(JoinTest, Kinds, KindName);

TYPED_TEST(JoinTest, ATabRendersJobsAlone) {
  const auto tab = this->open(2);
  for (const char* scene : {"cornell", "mesh", "textured", "motion"}) {
    const auto what = this->settings(scene, "40");
    Process client = this->submit(what);
    this->expect_same_bytes(client, what);
  }
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'waiting'"));
}

TYPED_TEST(JoinTest, ATabBesideANativeWorkerGivesTheSameBytes) {
  this->farm_->add_worker("native", 1);
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "400");
  Process client = this->submit(what);
  EXPECT_TRUE(this->has_rendered(*tab));
  this->expect_same_bytes(client, what);
}

TYPED_TEST(JoinTest, AJobSurvivesItsTabs) {
  this->farm_->add_worker("native", 1);
  auto closed = this->open(1);
  const auto reloaded = this->open(1);
  const auto frozen = this->open(1);
  const auto what = this->settings("cornell", "1500");
  Process client = this->submit(what);
  for (TypeParam* tab : {closed.get(), reloaded.get(), frozen.get()}) {
    EXPECT_TRUE(this->has_rendered(*tab));
  }
  const std::vector<pid_t> processes = family(frozen->pid());
  signal_all(processes, SIGSTOP);
  closed.reset();
  reloaded->reload();
  this->start(*reloaded, 1);
  this->expect_same_bytes(client, what);
  signal_all(processes, SIGCONT);
}

TYPED_TEST(JoinTest, ATabPausesAndGoesOn) {
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "150");
  Process client = this->submit(what);
  EXPECT_TRUE(this->has_rendered(*tab));
  tab->run("document.querySelector('#pause').click()");
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'paused'"));
  tab->run("document.querySelector('#pause').click()");
  this->expect_same_bytes(client, what);
}

TYPED_TEST(JoinTest, ATabComesBackToARestartedCoordinator) {
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "150");
  Process client = this->submit(what);
  EXPECT_TRUE(this->has_rendered(*tab));
  this->farm_->coordinator().signal(SIGKILL);
  ASSERT_EQ(this->farm_->coordinator().wait(), 128 + SIGKILL);
  this->farm_->restart_coordinator();
  this->expect_same_bytes(client, what);
}

TYPED_TEST(JoinTest, ATabStopsWhenItsLinkIsRevoked) {
  const auto tab = this->open(1);
  expect_success(run(this->farm_->command({"link", "--revoke"})));
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'stopped'"));
}

}  // namespace
}  // namespace bandsaw::test
