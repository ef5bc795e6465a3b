// Kill any worker, freeze it, kill the coordinator, join in the middle: the job ends with the same
// bytes, and no finished band is rendered again because of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

const std::string kScene = std::string(BANDSAW_GALLERY) + "/cornell.textproto";
const std::vector<std::string> kSettings = {"--width", "200",       "--height",
                                            "200",     "--samples", "160"};

class Survive : public testing::Test {
 protected:
  Process submit() {
    std::vector<std::string> arguments = {"submit", kScene, "-o", farm_.path("farm.pfm")};
    arguments.insert(arguments.end(), kSettings.begin(), kSettings.end());
    return Process::start(farm_.command(arguments));
  }

  void wait_until_stored(const std::string& worker, std::size_t bands) {
    ASSERT_TRUE(farm_.worker(worker).wait_until([&](const std::string&, const std::string& log) {
      return logged_bands(log, "stored").size() >= bands;
    })) << farm_.worker_log(worker);
  }

  void expect_the_same_bytes(Process& client) {
    const std::optional<int> code = client.wait();
    ASSERT_EQ(code, 0) << client.out() << client.err() << farm_.coordinator().err();
    std::vector<std::string> local = {BANDSAW_BIN, "render", kScene, "-o", farm_.path("local.pfm")};
    local.insert(local.end(), kSettings.begin(), kSettings.end());
    const Finished finished = run(local);
    ASSERT_EQ(finished.code, 0) << finished.err;
    EXPECT_TRUE(file_bytes(farm_.path("farm.pfm")) == file_bytes(farm_.path("local.pfm")));
  }

  // Rows that two workers may both have rendered on purpose: at the end of a job the coordinator
  // gives what a slow worker has in hand to idle ones too, and says so in its log.
  bool shared(const LoggedBand& one, const LoggedBand& other) {
    const auto within = [&](const LoggedBand& band, const LoggedBand& whole) {
      const std::uint32_t first = std::max(one.first_row, other.first_row);
      const std::uint32_t last = std::min(one.last_row, other.last_row);
      return band.overlaps(whole) && whole.first_row <= first && last <= whole.last_row;
    };
    const std::string log = farm_.coordinator_log();
    for (const char* verb : {"copied", "moved"}) {
      for (const LoggedBand& band : logged_bands(log, verb)) {
        if (within(one, band) && within(other, band)) {
          return true;
        }
      }
    }
    return false;
  }

  // Bands that some worker had stored and another rendered too, without having been asked to help
  // it; and bands one worker rendered twice.
  int rendered_again() {
    int again = 0;
    for (const std::string& one : farm_.worker_names()) {
      const std::vector<LoggedBand> stored = logged_bands(farm_.worker_log(one), "stored");
      const std::vector<LoggedBand> own = logged_bands(farm_.worker_log(one), "rendered");
      for (std::size_t i = 0; i < own.size(); ++i) {
        for (std::size_t j = i + 1; j < own.size(); ++j) {
          again += own[i].overlaps(own[j]) && !shared(own[i], own[j]);
        }
      }
      for (const std::string& other : farm_.worker_names()) {
        if (one == other) {
          continue;
        }
        for (const LoggedBand& theirs : logged_bands(farm_.worker_log(other), "rendered")) {
          for (const LoggedBand& ours : stored) {
            again += ours.overlaps(theirs) && !shared(ours, theirs);
          }
        }
      }
    }
    return again;
  }

  FarmProcesses farm_;
};

TEST_F(Survive, AKilledWorker) {
  farm_.add_worker("victim", 1);
  farm_.add_worker("other", 1);
  Process client = submit();
  wait_until_stored("victim", 3);
  farm_.worker("victim").signal(SIGKILL);
  expect_the_same_bytes(client);
  EXPECT_EQ(rendered_again(), 0);
}

TEST_F(Survive, AFrozenWorker) {
  farm_.add_worker("victim", 1);
  farm_.add_worker("other", 1);
  Process client = submit();
  wait_until_stored("victim", 2);
  farm_.worker("victim").signal(SIGSTOP);
  expect_the_same_bytes(client);
  EXPECT_EQ(rendered_again(), 0);
  farm_.worker("victim").signal(SIGCONT);
  EXPECT_TRUE(farm_.worker("victim").wait_until([](const std::string&, const std::string& log) {
    return log.find("joined", log.find("joined") + 1) != std::string::npos;
  })) << "the worker that woke up did not join again: "
      << farm_.worker_log("victim");
}

TEST_F(Survive, AWorkerThatJoinsInTheMiddle) {
  farm_.add_worker("first", 1);
  Process client = submit();
  wait_until_stored("first", 3);
  farm_.add_worker("late", 1);
  expect_the_same_bytes(client);
  EXPECT_GT(logged_bands(farm_.worker_log("late"), "stored").size(), 0u);
  EXPECT_EQ(rendered_again(), 0);
}

TEST_F(Survive, AKilledCoordinator) {
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  Process client = submit();
  wait_until_stored("one", 3);
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  expect_the_same_bytes(client);
  EXPECT_EQ(rendered_again(), 0);
}

TEST_F(Survive, AWorkerThatIsAskedToLeave) {
  farm_.add_worker("leaving", 1);
  farm_.add_worker("staying", 1);
  Process client = submit();
  wait_until_stored("leaving", 2);
  farm_.worker("leaving").signal(SIGTERM);
  EXPECT_EQ(farm_.worker("leaving").wait(), 0);
  // Drained: what it had rendered it handed over.
  EXPECT_EQ(logged_bands(farm_.worker_log("leaving"), "rendered").size(),
            logged_bands(farm_.worker_log("leaving"), "stored").size());
  expect_the_same_bytes(client);
  EXPECT_EQ(rendered_again(), 0);
}

}  // namespace
}  // namespace bandsaw::test
