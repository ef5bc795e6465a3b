#pragma once

// What runs on another machine to bring a worker there or to take it away: POSIX shell and what
// every Linux has. They say how it went on one line of standard output that begins with
// kRemoteResult.

#include <cstdint>
#include <string>

#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

inline constexpr char kRemoteResult[] = "bandsaw-result: ";

/// Says which system the host runs and its architecture, as `uname` names them: "Linux x86_64".
std::string machine_script();

/// Reads from standard input a line with the join string, then the program's bytes, `size` of them.
/// Puts it into ~/.local/share/bandsaw-worker, in the place of what an earlier invitation left
/// there, and starts it: by systemd --user where the user has that, else on its own.
std::string invite_script(std::uint64_t size, const wire::Digest& program);

/// Lets the worker finish what it holds, `drain_s` seconds at most, then ends it and removes all
/// that an invitation left. Fine where there is nothing.
std::string dismiss_script(int drain_s);

}  // namespace bandsaw::coordinator
