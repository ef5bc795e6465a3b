// Commands that control a running job: pause, resume, priority, why.

#include <gtest/gtest.h>

#include <csignal>

#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/sanitized.h"

namespace bandsaw::test {
namespace {

// kSlower is above 1 if the build has a sanitizer, which makes tests slow.
const std::vector<std::string> kControlSettings = {
    "--width", "128", "--height", "128", "--samples", std::to_string(32 / kSlower)};

class Control : public testing::Test {
 protected:
  /// Runs a command as a user of the farm. It must succeed. Returns its standard output.
  std::string say(std::vector<std::string> arguments) {
    const Finished finished = run(farm_.command(std::move(arguments)));
    EXPECT_EQ(finished.code, 0) << finished.err;
    return finished.out;
  }

  // Repeats the command until its output contains `text`, and returns the output. Only the test's
  // own timeout limits the time.
  std::string ask_until(const std::vector<std::string>& arguments, const std::string& text) {
    std::string out;
    while (!testing::Test::HasFailure() && out.find(text) == std::string::npos) {
      out = say(arguments);
    }
    return out;
  }

  /// Returns the first field "samples_done" of the text, with its value.
  static std::string samples_done(const std::string& json) {
    const std::size_t at = json.find("\"samples_done\":");
    return json.substr(at, json.find(',', at) - at);
  }

  void expect_the_same_bytes(const std::string& file) {
    std::vector<std::string> local = {BANDSAW_BIN, "render", kCornell, "-o",
                                      farm_.path("local.pfm")};
    local.insert(local.end(), kControlSettings.begin(), kControlSettings.end());
    const Finished finished = run(local);
    ASSERT_EQ(finished.code, 0) << finished.err;
    EXPECT_TRUE(file_bytes(file) == file_bytes(farm_.path("local.pfm")));
  }

  FarmProcesses farm_;
};

// A leased job is one of which a worker has rows to render.
TEST_F(Control, APausedJobIsNotLeasedAndContinuesToTheSameBytes) {
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  std::vector<std::string> submit = {"submit", kCornell, "-o", farm_.path("farm.pfm")};
  submit.insert(submit.end(), kControlSettings.begin(), kControlSettings.end());
  Process client = Process::start(farm_.command(submit));
  ASSERT_TRUE(farm_.worker("one").wait_until([&](const std::string&, const std::string& log) {
    return logged_bands(log, "stored").size() >= 2;
  }));
  EXPECT_NE(say({"pause", "1"}).find("job 1 is paused"), std::string::npos);
  ask_until({"jobs", "--json"}, R"("workers":[])");
  const std::string paused = say({"jobs", "--json"});
  EXPECT_NE(paused.find(R"("state":"paused")"), std::string::npos) << paused;
  EXPECT_NE(say({"why", "1"}).find("paused by a user"), std::string::npos);
  EXPECT_NE(say({"workers"}).find("idle"), std::string::npos);
  EXPECT_EQ(samples_done(say({"jobs", "--json"})), samples_done(paused));
  say({"resume", "1"});
  ASSERT_EQ(client.wait(), 0) << client.err();
  expect_the_same_bytes(farm_.path("farm.pfm"));
}

TEST_F(Control, PrioritiesAreShownAndKeptOverARestart) {
  say({"submit", kCornell, "--samples", "16", "--detach", "--priority", "5"});
  EXPECT_NE(say({"jobs", "--json"}).find(R"("priority":5)"), std::string::npos);
  say({"priority", "1", "-20"});
  farm_.coordinator().signal(SIGKILL);
  farm_.coordinator().wait();
  farm_.restart_coordinator();
  EXPECT_NE(say({"jobs"}).find("-20"), std::string::npos);
  EXPECT_NE(say({"why", "1"}).find("no worker is connected"), std::string::npos);
  EXPECT_EQ(run(farm_.command({"pause", "99"})).code, 1);
  EXPECT_EQ(run(farm_.command({"priority", "1", "5000"})).code, 2);
}

}  // namespace
}  // namespace bandsaw::test
