#include "coordinator/cli/base/spawn.h"

#include <signal.h>
#include <unistd.h>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw::coordinator {

absl::StatusOr<pid_t> spawn(const std::vector<std::string>& arguments,
                            const posix_spawn_file_actions_t& actions) {
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
  if (error != 0) {
    return errno_status(error, absl::StrCat("cannot start ", arguments[0]));
  }
  return pid;
}

}  // namespace bandsaw::coordinator
