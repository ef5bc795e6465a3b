// spawn() starts a program by posix_spawnp. No signal is blocked in the child, and SIGINT, SIGTERM
// and SIGPIPE have their default effect, even if this program ignores them.

#include "coordinator/cli/base/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw::coordinator {
namespace {

/// Adds an action for the child: its file descriptor `to` becomes a copy of `from`. If `from` is
/// -1, the child opens `file` with `flags` as `to` instead.
void add_stream(posix_spawn_file_actions_t& actions, int from, int to, const char* file,
                int flags) {
  if (from >= 0) {
    posix_spawn_file_actions_adddup2(&actions, from, to);
  } else {
    posix_spawn_file_actions_addopen(&actions, to, file, flags, 0);
  }
}

}  // namespace

absl::StatusOr<pid_t> spawn(const std::vector<std::string>& arguments,
                            const SpawnStreams& streams) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  add_stream(actions, streams.input, STDIN_FILENO, streams.input_file.c_str(), O_RDONLY);
  add_stream(actions, streams.output, STDOUT_FILENO, "/dev/null", O_WRONLY);
  add_stream(actions, streams.errors, STDERR_FILENO, "/dev/null", O_WRONLY);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t signals;
  sigemptyset(&signals);
  posix_spawnattr_setsigmask(&attributes, &signals);
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) {
    sigaddset(&signals, signal);
  }
  posix_spawnattr_setsigdefault(&attributes, &signals);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) {
    argv.push_back(const_cast<char*>(argument.c_str()));
  }
  argv.push_back(nullptr);
  pid_t pid = -1;
  const int error = posix_spawnp(&pid, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return errno_status(error, absl::StrCat("cannot start ", arguments[0]));
  }
  return pid;
}

}  // namespace bandsaw::coordinator
