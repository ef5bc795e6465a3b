// Tests the administration of a farm: logs, `doctor`, the rotation of secrets, links for browsers.
// Also tests a band that crashes its workers.

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "absl/strings/str_replace.h"
#include "proto/link/join.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

class Administration : public testing::Test {
 protected:
  /// Runs a command as a user of the farm, over the network.
  Finished say(std::vector<std::string> arguments) { return run(farm_.command(arguments)); }
  /// Runs a command on the coordinator's machine, with its data folder.
  Finished here(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), BANDSAW_BIN);
    arguments.insert(arguments.end(), {"--data", farm_.path("data")});
    return run(arguments);
  }

  // Repeats the command until its output contains `text`, and returns the output. Only the test's
  // own timeout limits the time.
  std::string ask_until(const std::vector<std::string>& arguments, const std::string& text) {
    std::string out;
    while (!HasFailure() && out.find(text) == std::string::npos) {
      out = say(arguments).out;
    }
    return out;
  }

  FarmProcesses farm_;
};

// Scripts, such as the script in the README, wait for the users' file and then start a worker with
// the workers' file. So the workers' file must be there first.
TEST_F(Administration, TheFileForUsersIsWrittenLast) {
  EXPECT_LE(std::filesystem::last_write_time(farm_.join_file()),
            std::filesystem::last_write_time(farm_.farm_file()));
}

// The address "127.1" stands for a name that DNS does not know, such as a name of mDNS. The
// system's resolver reads "127.1" as 127.0.0.1. gRPC's own resolver does not know it.
TEST_F(Administration, NamesAreLookedUpByTheSystem) {
  const auto named = [&](const std::string& file) {
    link::JoinString join = *link::join_string_from(file);
    join.addresses = {absl::StrReplaceAll(join.addresses.front(), {{"127.0.0.1", "127.1"}})};
    return join.text();
  };
  EXPECT_EQ(run({BANDSAW_BIN, "jobs", "--farm", named(farm_.farm_file())}).code, 0);
  Process worker =
      Process::start({BANDSAW_WORKER_BIN, "--join", named(farm_.join_file()), "--threads", "1",
                      "--name", "desk", "--cache", farm_.path("cache")});
  EXPECT_TRUE(worker.wait_for("joined 127.1:")) << worker.err();
}

TEST_F(Administration, AWorkersLogIsReadOverTheNetwork) {
  farm_.add_worker("desk", 1);
  ask_until({"logs", "desk"}, "joined");
  EXPECT_EQ(
      say({"submit", kCornell, "--width", "32", "--samples", "16", "-o", farm_.path("a.png")}).code,
      0);
  const std::string log = ask_until({"logs", "desk"}, "stored job=1");
  EXPECT_NE(log.find("rendered job=1"), std::string::npos) << log;
  farm_.coordinator().signal(SIGKILL);
  farm_.coordinator().wait();
  farm_.restart_coordinator();
  ask_until({"logs", "desk"}, "stored job=1");  // sent again to the restarted coordinator
  const Finished unknown = say({"logs", "nobody"});
  EXPECT_EQ(unknown.code, 1);
  EXPECT_NE(unknown.err.find("desk"), std::string::npos) << unknown.err;
}

TEST_F(Administration, TheDoctorReportsNoProblemForUsersAndWorkers) {
  farm_.add_worker("desk", 1);
  for (const std::string& join : {farm_.farm_file(), farm_.join_file()}) {
    const Finished well = run({BANDSAW_BIN, "doctor", "--farm", join, "--data", farm_.path("data"),
                               "--listen", "127.0.0.1:0"});
    EXPECT_EQ(well.code, 0) << well.out << well.err;
    for (const char* part : {"1 worker is connected", "certificate", "as here", "clock"}) {
      EXPECT_NE(well.out.find(part), std::string::npos) << part << " in: " << well.out;
    }
  }
}

TEST_F(Administration, TheDoctorNamesEachProblem) {
  farm_.coordinator().signal(SIGTERM);
  farm_.coordinator().wait();
  const Finished ill = say({"doctor", "--data", farm_.path("data"), "--listen", "192.0.2.1:7878"});
  EXPECT_EQ(ill.code, 1) << ill.out;
  EXPECT_NE(ill.out.find("problem  farm"), std::string::npos) << ill.out;
  EXPECT_NE(ill.out.find("problem  port"), std::string::npos) << ill.out;
  EXPECT_NE(ill.out.find("ok       import"), std::string::npos) << ill.out;
}

TEST_F(Administration, AWorkersOldSecretIsVoidAtOnceAndAWorkerJoinsWithTheNewOne) {
  Process& old = farm_.add_worker("old", 1);
  const std::string before = file_bytes(farm_.join_file());
  const Finished rotated = here({"secret", "rotate", "worker"});
  EXPECT_EQ(rotated.code, 0) << rotated.err;
  EXPECT_TRUE(old.wait_for("void")) << old.err();
  EXPECT_NE(file_bytes(farm_.join_file()), before);
  const Finished stranger = run({BANDSAW_WORKER_BIN, "--join", before, "--cache", farm_.path("c")});
  EXPECT_EQ(stranger.code, 2) << stranger.err;
  farm_.add_worker("new", 1);
}

TEST_F(Administration, TheUsersSecretIsRenewedWithAndWithoutACoordinator) {
  const std::string first = file_bytes(farm_.farm_file());
  EXPECT_EQ(here({"secret", "rotate", "farm"}).code, 0);
  EXPECT_EQ(run({BANDSAW_BIN, "jobs", "--farm", first}).code, 2);
  EXPECT_EQ(say({"jobs"}).code, 0);
  farm_.coordinator().signal(SIGTERM);
  farm_.coordinator().wait();
  const std::string second = file_bytes(farm_.farm_file());
  EXPECT_EQ(here({"secret", "rotate", "farm"}).code, 0);
  farm_.restart_coordinator();
  EXPECT_EQ(run({BANDSAW_BIN, "jobs", "--farm", second}).code, 2);
  EXPECT_EQ(say({"jobs"}).code, 0);
}

TEST_F(Administration, AJoinFileThatWasRemovedIsWrittenWithTheNewSecret) {
  std::filesystem::remove(farm_.join_file());
  EXPECT_EQ(here({"secret", "rotate", "worker"}).code, 0);
  farm_.add_worker("new", 1);
  // If no coordinator runs, the next coordinator writes the file when it starts.
  farm_.coordinator().signal(SIGTERM);
  farm_.coordinator().wait();
  std::filesystem::remove(farm_.join_file());
  const Finished rotated = here({"secret", "rotate", "worker"});
  EXPECT_NE(rotated.out.find("at its next start"), std::string::npos) << rotated.out;
}

TEST_F(Administration, ALinkForBrowsersLastsUntilItIsRevokedOrASecretIsRenewed) {
  const auto secret = [&](std::vector<std::string> more = {}) {
    more.insert(more.begin(), "link");
    const std::string url = say(more).out;
    const std::size_t mark = url.find("/join#");
    EXPECT_NE(mark, std::string::npos) << url;
    return url.substr(mark + 6, 22);  // the secret, 22 characters, follows "/join#"
  };
  std::string before = secret({"--for", "2h"});
  EXPECT_EQ(secret(), before);
  farm_.coordinator().signal(SIGKILL);
  farm_.coordinator().wait();
  farm_.restart_coordinator();
  EXPECT_EQ(secret(), before) << "a restart must keep the secret";
  EXPECT_EQ(say({"link", "--revoke"}).code, 0);
  for (const char* role : {"worker", "farm"}) {
    const std::string next = secret();
    EXPECT_NE(next, before);
    before = next;
    EXPECT_EQ(here({"secret", "rotate", role}).code, 0);
  }
  const std::string last = secret();
  EXPECT_NE(last, before);
  farm_.coordinator().signal(SIGTERM);
  farm_.coordinator().wait();
  EXPECT_EQ(here({"secret", "rotate", "worker"}).code, 0);
  farm_.restart_coordinator();
  EXPECT_NE(secret(), last) << "a rotation without a coordinator must change the secret too";
}

// The job is one band of a million samples, so each worker is killed while it renders this band.
// The first loss makes the band suspect. On a farm that has not stored a band before, the job fails
// after five more losses (coordinator/scheduler/liveness/crash_attribution.h).
TEST_F(Administration, ABandThatCrashesEveryWorkerFailsItsJob) {
  EXPECT_EQ(
      say({"submit", kCornell, "--width", "65536", "--height", "1", "--samples", "16", "--detach"})
          .code,
      0);
  for (const char* name : {"one", "two", "three", "four", "five", "six"}) {
    Process& worker = farm_.add_worker(name, 1);
    ask_until({"jobs", "--json"}, std::string(R"("workers":[{"name":")") + name);
    worker.signal(SIGKILL);
    worker.wait();
  }
  const std::string jobs = ask_until({"jobs", "--json"}, R"("state":"failed")");
  EXPECT_NE(jobs.find("6 workers were lost while they rendered rows 0–1"), std::string::npos)
      << jobs;
}

}  // namespace
}  // namespace bandsaw::test
