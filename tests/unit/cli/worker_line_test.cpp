// The shell line that a user pastes on a machine without a worker. The line downloads the program
// for the machine's architecture, checks the program and starts it. The tests run the line in a
// real shell, in which scripts replace uname and curl.

#include "coordinator/cli/machines/worker_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using test::Finished;
using testing::HasSubstr;
using testing::Not;

/// Returns a shell script that stands in for the worker program of `machine`. The script prints the
/// name of the machine and the arguments that the script gets.
std::string program(Machine machine) {
  return absl::StrCat("#!/bin/sh\necho ", machine_name(machine), " started \"$@\"\n");
}

class WorkerLine : public ::testing::Test {
 protected:
  WorkerLine() {
    std::filesystem::create_directory(folder_ / "bin");
    std::filesystem::create_directory(folder_ / "home");
    for (const Machine machine : kMachines) {
      write(absl::StrCat("program-", machine_name(machine)), program(machine));
      write(absl::StrCat("program-", other_machine_name(machine)), program(machine));
      digests_[machine] = wire::sha256(program(machine));
    }
    // A stand-in for curl, which is called as `curl --noproxy '*' -fsS URL -o FILE`. It records the
    // URL, and copies the program that the last part of the URL names to FILE.
    write("bin/curl", "#!/bin/sh\necho \"$4\" >>" + folder_.path() + "/downloaded\ncp \"" +
                          folder_.path() + "/program-${4##*/}\" \"$6\"\n");
  }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    std::filesystem::permissions(folder_ / name, std::filesystem::perms::owner_all);
  }
  /// Runs the line in an empty home folder. `uname`: the output of uname -m.
  Finished paste(const std::string& uname) {
    write("uname", uname);
    write("bin/uname", "#!/bin/sh\n[ \"$*\" = -m ] && cat " + folder_.path() + "/uname\n");
    return test::run(
        {"/bin/sh", "-c",
         absl::StrCat("cd ", folder_ / "home", " && ",
                      worker_line("http://desk:1", /*public_key=*/std::nullopt, digests_, "JOIN"))},
        {"PATH=" + folder_ / "bin" + ":/usr/bin:/bin"});
  }
  bool downloaded() const { return std::filesystem::exists(folder_ / "downloaded"); }
  bool home_is_empty() const { return std::filesystem::is_empty(folder_ / "home"); }

  test::TempDir folder_;
  WorkerDigests digests_;
};

// An architecture has two names, for example aarch64 and arm64. The line accepts both as the output
// of `uname -m`.
TEST_F(WorkerLine, EachArchitectureGetsItsProgramByEitherName) {
  for (const Machine machine : kMachines) {
    for (const absl::string_view name : {machine_name(machine), other_machine_name(machine)}) {
      const Finished pasted = paste(absl::StrCat(name, "\n"));
      EXPECT_EQ(pasted.code, 0) << pasted.err;
      EXPECT_THAT(pasted.out,
                  HasSubstr(absl::StrCat(machine_name(machine), " started --join JOIN")));
    }
  }
}

TEST_F(WorkerLine, TheDownloadUsesNoProxy) {
  write("bin/curl", "#!/bin/sh\nprintf '%s\\n' \"$1 $2\" >" + folder_.path() + "/downloaded\n");
  paste("x86_64\n");
  std::ifstream file(folder_ / "downloaded");
  std::string arguments;
  std::getline(file, arguments);
  EXPECT_EQ(arguments, "--noproxy *");
}

TEST_F(WorkerLine, TheProgramOfAnotherArchitectureIsNotStarted) {
  write("program-aarch64", program(Machine::kX86_64));
  const Finished pasted = paste("aarch64\n");
  EXPECT_EQ(pasted.code, 1);
  EXPECT_THAT(pasted.out, HasSubstr("FAILED"));
  EXPECT_THAT(pasted.out, Not(HasSubstr("started")));
}

TEST_F(WorkerLine, NothingIsDownloadedIfThereIsNoProgramForTheArchitecture) {
  digests_.erase(Machine::kAarch64);
  const Finished pasted = paste("aarch64\n");
  EXPECT_EQ(pasted.code, 1);
  EXPECT_EQ(pasted.err,
            "bandsaw-worker: the coordinator has no worker program for aarch64, only for x86_64\n");
  EXPECT_FALSE(downloaded());
  EXPECT_TRUE(home_is_empty());
}

TEST_F(WorkerLine, TheOutputOfUnameIsNeverExecuted) {
  for (const char* output : {"riscv64\n", "", "*\n", "-n\n", "x86_64 aarch64\n",
                             "x86_64\naarch64\n", "x86_64;touch run\n", "$(touch run)\n",
                             "`touch run`\n", "\"; touch run; \"\n", "../../x86_64\n"}) {
    const Finished pasted = paste(output);
    EXPECT_EQ(pasted.code, 1) << output;
    EXPECT_THAT(pasted.err, HasSubstr("the coordinator has no worker program for")) << output;
    EXPECT_FALSE(downloaded()) << output;
    EXPECT_TRUE(home_is_empty()) << output;
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
