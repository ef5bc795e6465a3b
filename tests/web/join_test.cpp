// Browsers as workers of a farm. Users who open the link for browsers render in a tab, with the
// renderer as WebAssembly. The image of a job has the same bytes as that of a local render,
// whatever the tabs do.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <signal.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <regex>

#include "absl/strings/str_cat.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/temp_dir.h"
#include "tests/web/browser.h"
#include "tests/web/firefox.h"

namespace bandsaw::test {
namespace {

namespace fs = std::filesystem;

/// Returns `parent` and all processes that descend from it.
std::vector<pid_t> family(pid_t parent) {
  std::multimap<pid_t, pid_t> children;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::string stat;
    std::getline(std::ifstream(entry.path() / "stat"), stat);
    // The text is "ID (NAME) STATE PARENT …", and STATE is one letter.
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

/// Returns the program that this kind of browser needs; empty: not installed. The argument only
/// selects the kind.
std::string program_of(const Browser*) { return chromedriver_program(); }
std::string program_of(const Firefox*) { return firefox_program(); }

/// Starts to render with `cores` cores in a tab that shows the page of the link.
template <class Kind>
void start(Kind& tab, int cores) {
  ASSERT_TRUE(tab.wait("document.querySelector('#start')?.offsetParent"));
  tab.run(absl::StrCat("document.querySelector('#cores').value = ", cores,
                       "; document.querySelector('#start').click();"));
  ASSERT_TRUE(tab.wait("['waiting', 'loading', 'rendering'].includes(document.body.dataset.phase)"))
      << tab.text("document.body.innerText");
}

/// Waits until the tab has rendered a row; returns false after 170 seconds.
template <class Kind>
bool has_rendered(Kind& tab) {
  return tab.wait("Number(document.body.dataset.rows) > 0");
}

/// A farm, and tabs of one kind of browser.
template <class Kind>
class JoinTest : public ::testing::Test {
 protected:
  void SetUp() override {
    check_installed<Kind>();
    if (!IsSkipped()) {
      start_farm(absl::StrCat("127.0.0.1:", free_port()));
    }
  }

  /// Skips the test if this kind of browser, or the renderer, is not installed.
  template <class AnyKind>
  static void check_installed() {
    if (program_of(static_cast<const AnyKind*>(nullptr)).empty()) {
      GTEST_SKIP() << "the browser is not installed (deploy/install.sh browser)";
    }
    if (!fs::exists(BANDSAW_WASM)) {
      GTEST_SKIP() << BANDSAW_WASM << " does not exist: run deploy/wasm.sh";
    }
  }

  /// Starts `program`, the command bandsaw, as the coordinator, and makes the link for browsers.
  /// `web`: address and port of the dashboard.
  void start_farm(const std::string& web, const std::string& program = BANDSAW_BIN) {
    farm_.emplace(hosts_.get(),
                  std::vector<std::string>{"--audit", "0%", "--browser-audit", "0%", "--web", web},
                  program);
    const Finished made = run(farm_->on("person", farm_->command({"link", "--json"})));
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

  /// Returns the arguments of `bandsaw submit` and `bandsaw render` for a scene of the gallery.
  std::vector<std::string> settings(const std::string& scene, const std::string& samples) const {
    return {std::string(BANDSAW_GALLERY) + "/" + scene + ".textproto",
            "--width",
            "96",
            "--samples",
            samples,
            "--quiet"};
  }
  /// Submits a job with these settings. The client waits for the image and writes it.
  Process submit(const std::vector<std::string>& what) {
    std::vector<std::string> arguments = {"submit"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    arguments.insert(arguments.end(), {"-o", farm_->path("farm.pfm")});
    return Process::start(farm_->on("person", farm_->command(arguments)));
  }
  /// Waits until the client has written the image of the farm. Expects that a local render with the
  /// same settings gives the same bytes.
  void expect_same_bytes(Process& client, const std::vector<std::string>& what) {
    ASSERT_EQ(client.wait(), 0) << client.err() << farm_->coordinator_log();
    std::vector<std::string> arguments = {BANDSAW_BIN, "render"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    arguments.insert(arguments.end(), {"-o", farm_->path("here.pfm")});
    expect_success(run(arguments));
    EXPECT_TRUE(file_bytes(farm_->path("farm.pfm")) == file_bytes(farm_->path("here.pfm")));
  }

  std::unique_ptr<Hosts> hosts_;  ///< nullptr: everything is on loopback
  std::optional<FarmProcesses> farm_;
  std::string link_;  ///< the link for browsers
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

TYPED_TEST(JoinTest, AnIdleTabShowsNoSpeedAndNoJob) {
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "150");
  Process client = this->submit(what);
  EXPECT_TRUE(tab->wait("document.querySelector('#pulse').textContent.includes('job 1')"));
  EXPECT_TRUE(tab->wait("document.querySelector('#speed').textContent.includes('/s')"));
  this->expect_same_bytes(client, what);
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'waiting'"));
  EXPECT_TRUE(tab->wait("!document.querySelector('#speed').textContent.includes('/s')"));
  EXPECT_TRUE(tab->wait("!document.querySelector('#pulse').textContent.includes('job')"));
}

TYPED_TEST(JoinTest, ATabBesideANativeWorkerGivesTheSameBytes) {
  this->farm_->add_worker("native", 1);
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "400");
  Process client = this->submit(what);
  EXPECT_TRUE(has_rendered(*tab));
  this->expect_same_bytes(client, what);
}

TYPED_TEST(JoinTest, AJobEndsAlthoughItsTabsAreClosedReloadedAndFrozen) {
  this->farm_->add_worker("native", 1);
  auto closed = this->open(1);
  const auto reloaded = this->open(1);
  const auto frozen = this->open(1);
  const auto what = this->settings("cornell", "1500");
  Process client = this->submit(what);
  for (TypeParam* tab : {closed.get(), reloaded.get(), frozen.get()}) {
    EXPECT_TRUE(has_rendered(*tab));
  }
  const std::vector<pid_t> processes = family(frozen->pid());
  signal_all(processes, SIGSTOP);
  closed.reset();
  reloaded->reload();
  start(*reloaded, 1);
  this->expect_same_bytes(client, what);
  signal_all(processes, SIGCONT);
}

TYPED_TEST(JoinTest, ATabPausesAndGoesOn) {
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "150");
  Process client = this->submit(what);
  EXPECT_TRUE(has_rendered(*tab));
  tab->run("document.querySelector('#pause').click()");
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'paused'"));
  tab->run("document.querySelector('#pause').click()");
  this->expect_same_bytes(client, what);
}

TYPED_TEST(JoinTest, ATabComesBackToARestartedCoordinator) {
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "150");
  Process client = this->submit(what);
  EXPECT_TRUE(has_rendered(*tab));
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

class BothBrowsersTest : public JoinTest<Browser> {
 protected:
  void SetUp() override {
    check_installed<Firefox>();
    if (!IsSkipped()) {
      JoinTest::SetUp();
    }
  }
};

TEST_F(BothBrowsersTest, ChromiumAndFirefoxGiveTheBytesOfANativeWorker) {
  Process& native = farm_->add_worker("native", 1);
  const auto chromium = open(1);
  Firefox firefox;
  firefox.go(link_);
  start(firefox, 1);
  const auto what = settings("cornell", "600");
  Process client = submit(what);
  EXPECT_TRUE(native.wait_for("stored job=1"));
  EXPECT_TRUE(has_rendered(*chromium));
  EXPECT_TRUE(has_rendered(firefox));
  expect_same_bytes(client, what);
}

/// The coordinator, a native worker, the tab and a user are each on a machine of its own. A machine
/// is a network namespace with a cable. The dashboard is not on loopback, so tabs reach it by TLS.
template <class Kind>
class PulledCableTest : public JoinTest<Kind> {
 protected:
  void SetUp() override {
    this->template check_installed<Kind>();
    if (this->IsSkipped()) {
      return;
    }
    auto hosts = Hosts::create({"coordinator", "native", "tab", "person"});
    if (!hosts.ok()) {
      GTEST_SKIP() << hosts.status().message();
    }
    this->hosts_ = *std::move(hosts);
    this->start_farm(this->hosts_->address("coordinator") + ":8787");
    visit_ = this->hosts_->visit("tab");
  }

  /// Pulls the cable of a tab that renders, and waits until the coordinator and the tab have
  /// noticed it. Then the leases of the tab are over.
  void pull_cable(Kind& tab) {
    this->hosts_->unplug("tab");
    const std::regex lost("@browser.*(closed|disconnected|answers no more)");
    ASSERT_TRUE(this->farm_->coordinator().wait_until([&](const std::string&,
                                                          const std::string& log) {
      return std::regex_search(log, lost);
    })) << this->farm_->coordinator_log();
    ASSERT_TRUE(tab.wait("document.body.dataset.phase === 'connecting'"));
  }

  std::unique_ptr<Hosts::Visit> visit_;  ///< the test drives the browser from the tab's machine
};

TYPED_TEST_SUITE(PulledCableTest, Kinds, KindName);

TYPED_TEST(PulledCableTest, ATabContinuesAfterItsCableIsPluggedInAgain) {
  const auto tab = this->open(1);
  EXPECT_EQ(this->link_.substr(0, 8), "https://");
  const auto what = this->settings("cornell", "200");
  Process client = this->submit(what);
  EXPECT_TRUE(has_rendered(*tab));
  this->pull_cable(*tab);
  this->hosts_->plug("tab");
  this->expect_same_bytes(client, what);
}

TYPED_TEST(PulledCableTest, AJobContinuesWithoutATabThatReturnsForTheNextJob) {
  Process& native = this->farm_->add_worker("native", 1);
  const auto tab = this->open(1);
  const auto what = this->settings("cornell", "500");
  Process client = this->submit(what);
  EXPECT_TRUE(has_rendered(*tab));
  this->pull_cable(*tab);
  this->expect_same_bytes(client, what);
  native.signal(SIGKILL);
  const auto next = this->settings("mesh", "16");
  client = this->submit(next);
  this->hosts_->plug("tab");
  this->expect_same_bytes(client, next);
}

/// Returns the WebAssembly module with its memory limited to `pages` pages of 64 KiB. The number of
/// the old limit is replaced by the new number, which is encoded in as many bytes.
std::string with_memory(std::string module, std::uint32_t pages) {
  std::size_t at = 8;
  const auto number = [&] {  // LEB128
    std::uint32_t value = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = static_cast<unsigned char>(module.at(at++));
      value |= std::uint32_t{byte} % 128 << shift;
      if (byte < 128) {
        return value;
      }
    }
  };
  while (module.at(at++) != 5) {  // the section of the memory
    const std::uint32_t size = number();
    at += size;
  }
  number();  // size of the section
  number();  // number of memories
  EXPECT_EQ(number(), 1U) << "the memory must have a limit";
  number();  // pages at the start
  std::size_t digits = at;
  number();
  for (; digits < at; ++digits) {
    module[digits] = static_cast<char>(pages % 128 + (digits + 1 < at ? 128 : 0));
    pages /= 128;
  }
  return module;
}

TYPED_TEST(JoinTest, ASceneThatExhaustsTheMemoryIsGivenBackAndNotTakenAgain) {
  // The browsers of this coordinator get 20 MB. The scene "instances" needs twice as much.
  const TempDir folder;
  fs::create_directories(folder / "bin");
  fs::create_directories(folder / "share/bandsaw/browser");
  fs::copy_file(BANDSAW_BIN, folder / "bin/bandsaw");
  std::ofstream(folder / "share/bandsaw/browser/bandsaw.wasm", std::ios::binary)
      << with_memory(file_bytes(BANDSAW_WASM), 320);
  this->start_farm(absl::StrCat("127.0.0.1:", free_port()), folder / "bin/bandsaw");
  const auto tab = this->open(1);
  const auto what = this->settings("instances", "16");
  Process client = this->submit(what);
  EXPECT_TRUE(tab->wait("document.body.dataset.text.includes('needs more memory')"));
  EXPECT_THAT(this->farm_->coordinator_log(), ::testing::HasSubstr("MB in use"));
  EXPECT_TRUE(tab->wait("document.body.dataset.phase === 'waiting'"));
  const Finished why = run(this->farm_->command({"why", "1"}));
  EXPECT_THAT(why.out, ::testing::HasSubstr("its scene needs about"));
  Process& native = this->farm_->add_worker("native", 1);
  this->expect_same_bytes(client, what);
  EXPECT_EQ(tab->text("document.body.dataset.rows"), "0");
  // A smaller scene without photon maps is rendered. (With the maps of "cornell", 20 MB are not
  // enough.)
  native.signal(SIGKILL);
  const auto next = this->settings("spheres", "16");
  client = this->submit(next);
  this->expect_same_bytes(client, next);
}

}  // namespace
}  // namespace bandsaw::test
