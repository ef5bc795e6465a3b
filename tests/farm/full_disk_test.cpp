// Tests a coordinator that is started on a full disk: a small tmpfs holds its data folder. Also
// tests commands whose standard output is on a full disk or has no reader.

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <optional>

#include "proto/link/join.h"
#include "tests/farm/band_log.h"
#include "tests/farm/farm_processes.h"
#include "tests/support/sanitized.h"

namespace bandsaw::test {
namespace {

using testing::HasSubstr;

// kSlower is above 1 if the build has a sanitizer, which makes tests slow.
std::vector<std::string> with_samples(std::vector<std::string> arguments, int samples) {
  arguments.insert(arguments.end(), {"--width", "128", "--height", "128", "--samples",
                                     std::to_string(samples / kSlower)});
  return arguments;
}

class FullDiskFarm : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(mkdir(disk_.c_str(), 0700), 0);
    // There must be room for the coordinator's reserve (16 MiB, freed when the disk is full), and
    // for the 64 MiB that must be free before jobs continue.
    if (mount("tmpfs", disk_.c_str(), "tmpfs", 0, "size=192m") != 0) {
      GTEST_SKIP() << "needs the right to mount a small tmpfs (run as root)";
    }
    mounted_ = true;
    start();
  }
  void TearDown() override {
    worker_.reset();
    coordinator_.reset();
    if (mounted_) {
      EXPECT_EQ(umount(disk_.c_str()), 0);
    }
  }

  void start() {
    coordinator_.emplace(Process::start({BANDSAW_BIN, "serve", "--data", data(), "--listen",
                                         listen_, "--web", "none", "--audit", "0%"}));
    ASSERT_TRUE(coordinator_->wait_for("join with:")) << coordinator_->err();
    const auto join = link::join_string_from(data() + "/join");
    ASSERT_TRUE(join.ok()) << join.status();
    listen_ = join->addresses.front();
  }
  void start_worker() {
    worker_.emplace(Process::start({BANDSAW_WORKER_BIN, "--join", data() + "/join", "--name", "one",
                                    "--threads", "1", "--cache", folder_ / "cache"}));
    ASSERT_TRUE(worker_->wait_for("joined")) << worker_->err();
  }
  /// Brings the farm to this state: job 1 is done, job 2 is being rendered, job 3 waits. Then ends
  /// the coordinator and the worker.
  void stop_with_jobs() {
    start_worker();
    ASSERT_EQ(say(with_samples({"submit", kCornell, "-o", folder_ / "first.pfm"}, 8)).code, 0);
    ASSERT_EQ(say(with_samples({"submit", kCornell, "--detach"}, 64)).code, 0);
    ASSERT_EQ(say(with_samples({"submit", kCornell, "--detach"}, 64)).code, 0);
    ASSERT_TRUE(worker_->wait_until([](const std::string&, const std::string& log) {
      const auto stored = logged_bands(log, "stored");
      return std::count_if(stored.begin(), stored.end(),
                           [](const LoggedBand& band) { return band.job == 2; }) >= 2;
    })) << worker_->err();
    coordinator_->signal(SIGKILL);
    coordinator_->wait();
    worker_.reset();
  }
  /// Fills the disk to the last byte.
  void fill() {
    const int file = open((disk_ + "/filler").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    ASSERT_GE(file, 0);
    for (std::size_t size = 1 << 20; size > 0; size /= 2) {
      const std::string bytes(size, 'x');
      while (write(file, bytes.data(), bytes.size()) > 0) {
      }
    }
    close(file);
  }
  void make_room() { ASSERT_TRUE(std::filesystem::remove(disk_ + "/filler")); }

  /// Runs a command as a user of the farm.
  Finished say(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), BANDSAW_BIN);
    arguments.insert(arguments.end(), {"--farm", data() + "/farm"});
    return run(arguments);
  }
  /// Repeats the command until its output contains `text`; limited only by the test's own timeout.
  void ask_until(const std::vector<std::string>& arguments, const std::string& text) {
    std::string out;
    while (!HasFailure() && out.find(text) == std::string::npos) {
      out = say(arguments).out;
    }
  }
  void expect_local_bytes(const std::string& file, int samples) {
    const std::string local = folder_ / "local.pfm";
    ASSERT_EQ(run(with_samples({BANDSAW_BIN, "render", kCornell, "-o", local}, samples)).code, 0);
    EXPECT_TRUE(file_bytes(file) == file_bytes(local));
  }
  void expect_results_are_served_and_jobs_paused() {
    EXPECT_THAT(coordinator_->err(), HasSubstr("disk is full"));
    EXPECT_THAT(say({"jobs", "--json"}).out, HasSubstr(R"("state":"paused")"));
    EXPECT_THAT(say({"why", "2"}).out, HasSubstr("disk is full"));
    EXPECT_EQ(say({"watch", "1", "-o", folder_ / "again.pfm"}).code, 0);
    EXPECT_TRUE(file_bytes(folder_ / "again.pfm") == file_bytes(folder_ / "first.pfm"));
    const Finished refused = say(with_samples({"submit", kCornell, "--detach"}, 32));
    EXPECT_NE(refused.code, 0);
    EXPECT_THAT(refused.out + refused.err, HasSubstr("disk is full"));
  }
  void expect_jobs_continue_when_there_is_room() {
    make_room();
    ask_until({"why", "2"}, "no worker is connected");
    start_worker();
    ASSERT_EQ(say({"watch", "2", "-o", folder_ / "second.pfm"}).code, 0);
    expect_local_bytes(folder_ / "second.pfm", 64);
  }
  std::string data() const { return disk_ + "/data"; }

  TempDir folder_;
  const std::string disk_ = folder_ / "disk";
  bool mounted_ = false;
  std::string listen_ = "127.0.0.1:0";
  std::optional<Process> coordinator_;
  std::optional<Process> worker_;
};

TEST_F(FullDiskFarm, StartsAndServesResultsAndContinuesWhenThereIsSpace) {
  ASSERT_NO_FATAL_FAILURE(stop_with_jobs());
  fill();
  ASSERT_NO_FATAL_FAILURE(start());
  expect_results_are_served_and_jobs_paused();
  EXPECT_EQ(say({"cancel", "3"}).code, 0) << "the reserve must leave room to cancel a job";
  EXPECT_FALSE(std::filesystem::exists(data() + "/jobs/3/bands"))
      << "the bands of a cancelled job must be deleted";
  expect_jobs_continue_when_there_is_room();
}

TEST_F(FullDiskFarm, StartsWithoutItsReserve) {
  ASSERT_NO_FATAL_FAILURE(stop_with_jobs());
  ASSERT_TRUE(std::filesystem::remove(data() + "/reserve"));
  fill();
  ASSERT_NO_FATAL_FAILURE(start());
  expect_results_are_served_and_jobs_paused();
  expect_jobs_continue_when_there_is_room();
}

// Every write to /dev/full fails as on a full disk.
TEST(FullDisk, AFullDiskBehindStandardOutputIsAnError) {
  for (const std::string command : {"info", "completion"}) {
    const Finished done = run({"/bin/sh", "-c", "exec \"$@\" > /dev/full", "sh", BANDSAW_BIN,
                               command, command == "info" ? kCornell : "bash"});
    EXPECT_EQ(done.code, 1);
    EXPECT_EQ(done.err, "bandsaw: standard output: No space left on device\n");
  }
}

// The standard output of `render` is a pipe to `true`, which ends at once. `render` ignores
// SIGPIPE, so it writes the image nevertheless.
TEST(FullDisk, AReaderThatHasEndedIsNoError) {
  const TempDir folder;
  const Finished done =
      run({"/bin/sh", "-c", "{ \"$@\"; echo code $? >&2; } | true", "sh", BANDSAW_BIN, "render",
           kCornell, "--width", "32", "--samples", "1", "-o", folder / "a.png"});
  EXPECT_EQ(done.err, "code 0\n");
}

}  // namespace
}  // namespace bandsaw::test
