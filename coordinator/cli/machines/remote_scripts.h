#pragma once

// Scripts that run on another machine to install or to remove a worker: POSIX shell and tools that
// every Linux has. They print their result as one line of standard output that begins with
// kRemoteResult.

#include <cstdint>
#include <string>

#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

inline constexpr char kRemoteResult[] = "bandsaw-result: ";

/// Prints the system and the architecture of the host as `uname` does: "Linux x86_64".
std::string machine_script();

/// Reads from standard input a line with the join string, then the program's `size` bytes. Installs
/// the program into ~/.local/share/bandsaw-worker, replacing an earlier installation, and starts
/// it: by systemd --user if the user has that, otherwise as a process.
std::string invite_script(std::uint64_t size, const wire::Digest& program);

/// Lets the worker finish its bands, for at most `drain_s` seconds, then ends it and removes the
/// installation. Succeeds if there is none.
std::string dismiss_script(int drain_s);

}  // namespace bandsaw::coordinator
