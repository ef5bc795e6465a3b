// The confinement of the process that reads foreign files. The process has no network, cannot start
// other programs, has limited memory and time, and may use only two folders, one for reading and
// one for writing.

#include "renderlib/import/files/confine.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/landlock.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <functional>
#include <thread>

#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;

struct Folders {
  TempDir readable;
  TempDir writable;
  TempDir other;
};

// Runs `act` in a confined child process, and returns the result of `act`. Returns 200 if the
// process could not be confined, and 1000 + the number of the signal if a signal ended the process.
// The limits are 8 GiB of memory, 60 s of CPU time and files of 1 MiB.
int confined(const Folders& folders, const std::function<int()>& act) {
  const pid_t pid = fork();
  if (pid == 0) {
    const Confinement to{folders.readable.path(), folders.writable.path(), 8ull << 30, 60, 1 << 20};
    _exit(confine_this_process(to).ok() ? act() : 200);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

// Returns 0 if the file can be opened, otherwise the error number.
int opens(const std::string& path, int flags) {
  return open(path.c_str(), flags, 0600) >= 0 ? 0 : errno;
}

TEST(Confine, ForbidsSocketsOtherProgramsNewProcessesAndSignalsToOthers) {
  const Folders folders;
  EXPECT_EQ(confined(folders, [] { return socket(AF_INET, SOCK_STREAM, 0) < 0 ? errno : 0; }),
            EPERM);
  EXPECT_EQ(confined(folders, [] { return socket(AF_UNIX, SOCK_DGRAM, 0) < 0 ? errno : 0; }),
            EPERM);
  EXPECT_EQ(confined(folders,
                     [] {
                       execl("/bin/true", "true", nullptr);
                       return errno;
                     }),
            EPERM);
  EXPECT_EQ(confined(folders, [] { return fork() < 0 ? errno : 0; }), EPERM);
  EXPECT_EQ(confined(folders, [] { return kill(getppid(), 0) < 0 ? errno : 0; }), EPERM);
  EXPECT_EQ(confined(folders, [] { return syscall(SYS_tkill, getppid(), 0) < 0 ? errno : 0; }),
            EPERM);
  const auto signal_thread = [](pid_t process) {
    return syscall(SYS_tgkill, process, process, 0) < 0 ? errno : 0;
  };
  EXPECT_EQ(confined(folders, [&] { return signal_thread(getppid()); }), EPERM);
  EXPECT_EQ(confined(folders, [&] { return signal_thread(getpid()); }), 0);
}

TEST(Confine, StillAllowsThreadsAndMemory) {
  const Folders folders;
  EXPECT_EQ(confined(folders,
                     [] {
                       int done = 0;
                       std::thread([&done] {
                         done = static_cast<int>(std::string(1 << 20, 'x')[9]);
                       }).join();
                       return done;
                     }),
            'x');
}

TEST(Confine, ForbidsCoreDumpsAndLimitsCpuTime) {
  const Folders folders;
  EXPECT_EQ(confined(folders,
                     [] {
                       rlimit core{};
                       rlimit cpu{};
                       getrlimit(RLIMIT_CORE, &core);
                       getrlimit(RLIMIT_CPU, &cpu);
                       return core.rlim_max == 0 && cpu.rlim_max == 60 ? 0 : 1;
                     }),
            0);
}

// Batch systems set limits of CPU time, and only privileged users may raise them.
TEST(Confine, KeepsLowerLimitsThatItHasInherited) {
  const Folders folders;
  const pid_t pid = fork();
  if (pid == 0) {
    const rlimit inherited{30, 30};
    setrlimit(RLIMIT_CPU, &inherited);
    const Confinement to{folders.readable.path(), folders.writable.path(), 8ull << 30, 60, 1 << 20};
    rlimit cpu{};
    const bool is_confined = confine_this_process(to).ok() && getrlimit(RLIMIT_CPU, &cpu) == 0;
    _exit(is_confined ? static_cast<int>(cpu.rlim_max) : 200);
  }
  int status = 0;
  waitpid(pid, &status, 0);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 30);
}

TEST(Confine, AllowsOnlyTwoFoldersIfTheKernelHasLandlock) {
  if (syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION) < 0) {
    GTEST_SKIP() << "this kernel has no Landlock";
  }
  const Folders folders;
  const std::string inside = write_text(folders.readable, "a", "a");
  const std::string outside = write_text(folders.other, "b", "b");
  EXPECT_EQ(confined(folders, [&] { return opens(inside, O_RDONLY); }), 0);
  EXPECT_EQ(confined(folders, [&] { return opens(inside, O_WRONLY); }), EACCES);
  EXPECT_EQ(confined(folders, [&] { return opens(outside, O_RDONLY); }), EACCES);
  EXPECT_EQ(confined(folders, [&] { return opens("/etc/passwd", O_RDONLY); }), EACCES);
  EXPECT_EQ(confined(folders, [&] { return opens(folders.writable / "c", O_WRONLY | O_CREAT); }),
            0);
  EXPECT_EQ(confined(folders, [&] { return opens(folders.other / "d", O_WRONLY | O_CREAT); }),
            EACCES);
}

}  // namespace
}  // namespace bandsaw
