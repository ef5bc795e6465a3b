// Tests that a machine gets the worker for its architecture, x86-64 or ARM64. Workers are installed
// by `bandsaw invite` over ssh, and by the line that `bandsaw serve` prints for a user to paste on
// another machine. The ARM64 machines are simulated by a uname that prints their architecture. The
// program for them is a file with an ARM64 ELF header and a mark, the record that states the
// worker's version (tests/support/worker_file.h).

#include <elf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/farm/fake_machines.h"
#include "tests/farm/farm_processes.h"
#include "tests/farm/installed.h"
#include "tests/support/worker_file.h"

namespace bandsaw::test {
namespace {

using ::testing::HasSubstr;

constexpr char kUnameOfAarch64[] = "[ $1 = -s ] && echo Linux || echo aarch64\n";

#if defined(__x86_64__)
class InviteArchitectures : public ::testing::Test {
 protected:
  InviteArchitectures() { machines_.replace("phone", "uname", kUnameOfAarch64); }
  Finished invite(std::vector<std::string> hosts) {
    hosts.insert(hosts.begin(), {installed_.bandsaw(), "invite", "--join", farm_.join_file()});
    return run(hosts, machines_.environment());
  }
  void dismiss(const std::string& host) {
    EXPECT_EQ(run({installed_.bandsaw(), "dismiss", host}, machines_.environment()).code, 0);
  }
  /// Whether no file was sent to the host.
  bool got_nothing(const std::string& host) {
    return std::filesystem::is_empty(machines_.home(host));
  }

  FarmProcesses farm_;
  FakeMachines machines_;
  Installed installed_;
};

TEST_F(InviteArchitectures, EachHostGetsTheProgramForItsArchitecture) {
  const std::string program = worker_file(EM_AARCH64, fitting_mark());
  installed_.put_aarch64_worker(program);
  // chmod is called after the received program is checked. This script keeps a copy of that
  // program, and replaces it by a worker that runs on the test's machine.
  machines_.replace("phone", "chmod",
                    "cp \"$2\" \"$HOME/arrived\"; cp " BANDSAW_WORKER_BIN
                    " \"$2\"; exec /usr/bin/chmod \"$@\"\n");
  const Finished invited = invite({"desk", "phone"});
  EXPECT_EQ(invited.code, 0) << invited.out << invited.err;
  EXPECT_THAT(invited.out, HasSubstr("invited: 2 of 2 hosts"));
  EXPECT_EQ(file_bytes(machines_.home("phone") + "/arrived"), program);
  EXPECT_EQ(file_bytes(machines_.worker_folder("desk") + "/bandsaw-worker"),
            file_bytes(BANDSAW_WORKER_BIN));
  dismiss("desk");
  dismiss("phone");
}

TEST_F(InviteArchitectures, AMissingProgramIsReportedWithTheRemedy) {
  const Finished invited = invite({"desk", "phone"});
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(
      invited.err,
      HasSubstr("phone: there is no bandsaw-worker for aarch64 here: put it at " +
                installed_.aarch64_worker() + ", or install the package bandsaw-worker-arm64\n"));
  EXPECT_THAT(invited.out, HasSubstr("invited: 1 of 2 hosts"));
  EXPECT_TRUE(got_nothing("phone"));
  dismiss("desk");
}

TEST_F(InviteArchitectures, AFileThatIsNotTheProgramIsNotSent) {
  installed_.put_aarch64_worker(file_bytes(BANDSAW_WORKER_BIN));
  EXPECT_THAT(invite({"phone"}).err, HasSubstr("phone: " + installed_.aarch64_worker() +
                                               " is a program for x86_64, not for aarch64\n"));
  const std::string program = worker_file(EM_AARCH64, fitting_mark());
  installed_.put_aarch64_worker(program.substr(0, program.size() - 1));
  EXPECT_THAT(invite({"phone"}).err, HasSubstr(" is cut off: "));
  wire::WorkerMark old = fitting_mark();
  old.pixel_version -= 1;
  installed_.put_aarch64_worker(worker_file(EM_AARCH64, old));
  // 7.8.9: the version in fitting_mark().
  EXPECT_THAT(invite({"phone"}).err, HasSubstr(" is version 7.8.9 with protocol "));
  EXPECT_TRUE(got_nothing("phone"));
}

// On a 32-bit system with a 64-bit kernel, uname prints the kernel's architecture, but the loader
// of 64-bit programs is missing. So the worker cannot start. The error must name the kind of system
// that the worker needs. A script whose interpreter does not exist takes the place of the worker.
TEST_F(InviteArchitectures, AThirtyTwoBitSystemOnA64BitKernelIsReported) {
  installed_.put_aarch64_worker(worker_file(EM_AARCH64, fitting_mark()));
  machines_.replace("phone", "chmod",
                    "echo '#!/lib/no-such-loader' >\"$2\"; exec /usr/bin/chmod \"$@\"\n");
  const Finished invited = invite({"phone"});
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(invited.err, HasSubstr("phone: the worker does not run there: "));
  EXPECT_THAT(invited.err, HasSubstr("(it needs a 64-bit system with glibc)"));
  EXPECT_EQ(invited.err.find('\n'), invited.err.size() - 1)
      << "the error must be one line: " << invited.err;
}

TEST_F(InviteArchitectures, TheOutputOfAHostIsPrintedOnOneLine) {
  const std::vector<std::string> junk = {"echo riscv64",
                                         "echo Darwin arm64",
                                         "printf 'a\\033[2Jb'",
                                         "echo '$(touch \"$HOME/run\")'",
                                         "head -c 100000 /dev/zero | tr '\\0' x",
                                         "exit 1",
                                         "printf 'x\\nbandsaw-result: ok Linux x86_64\\n'"};
  std::vector<std::string> hosts;
  for (std::size_t i = 0; i < junk.size(); ++i) {
    hosts.push_back("junk" + std::to_string(i));
    machines_.replace(hosts.back(), "uname", junk[i] + "\n");
  }
  const Finished invited = invite(hosts);
  EXPECT_EQ(invited.code, 1);
  EXPECT_THAT(invited.out, HasSubstr("invited: 0 of 7 hosts"));
  EXPECT_EQ(std::count(invited.err.begin(), invited.err.end(), '\n'),
            static_cast<std::ptrdiff_t>(junk.size()))
      << invited.err;
  EXPECT_EQ(invited.err.find('\033'), std::string::npos);
  EXPECT_LT(invited.err.size(), junk.size() * 300);
  for (const std::string& host : hosts) {
    EXPECT_THAT(invited.err,
                HasSubstr(host + ": there is no worker for this machine (uname says: "));
    EXPECT_TRUE(got_nothing(host));
  }
}
#endif

TEST(PasteArchitectures, TheLineFetchesTheProgramForTheMachine) {
  const Installed installed;
  const std::string program = worker_file(EM_AARCH64, fitting_mark());
  installed.put_aarch64_worker(program);
  const TempDir folder;
  Process coordinator = Process::start({installed.bandsaw(), "serve", "--data", folder / "data",
                                        "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0"});
  const std::string line = line_to_paste(coordinator);
  std::filesystem::create_directory(folder / "bin");
  const Finished pasted =
      run({"/bin/sh", "-c", "cd " + folder.path() + " && uname() { echo arm64; }; " + line},
          {"PATH=/usr/bin:/bin"});
  EXPECT_THAT(pasted.out, HasSubstr("bandsaw-worker.new: OK")) << pasted.err;
  EXPECT_NE(pasted.code, 0) << "the line must fail, because this file cannot run";
  EXPECT_EQ(file_bytes(folder / "bandsaw-worker"), program);
}

TEST(PasteArchitectures, AFileThatIsNotTheProgramIsNotHandedOut) {
  const Installed installed;
  installed.put_aarch64_worker(file_bytes(BANDSAW_BIN));
  const TempDir folder;
  Process coordinator = Process::start({installed.bandsaw(), "serve", "--data", folder / "data",
                                        "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0"});
  EXPECT_EQ(line_to_paste(coordinator).find("arm64"), std::string::npos);
  EXPECT_THAT(
      coordinator.err(),
      HasSubstr("no worker for aarch64 is handed out: " + installed.aarch64_worker() + " is "));
}

}  // namespace
}  // namespace bandsaw::test
