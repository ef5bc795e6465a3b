#pragma once

// Scripts that run on another machine to install or to remove a worker, for `bandsaw invite` and
// `dismiss`. They need a POSIX shell and tools that every Linux has. Each prints its result as one
// line of standard output: kRemoteResult, "ok" or "failed", and a text.

#include <cstdint>
#include <string>

#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// The start of the line with the result.
inline constexpr char kRemoteResult[] = "bandsaw-result: ";

/// Returns a script whose result has the system and the architecture of the host as its text, in
/// the words of `uname`: "Linux x86_64".
std::string machine_script();

/// Returns a script that reads a line with the join string (the addresses of the farm and a secret)
/// and then the worker's program from standard input. `size`: number of bytes of the program.
/// `program`: SHA-256 of these bytes, which the script checks. The script installs the program into
/// ~/.local/share/bandsaw-worker, replacing an earlier installation, and starts it: by systemd
/// --user if that is available to the user, otherwise as a process.
std::string invite_script(std::uint64_t size, const wire::Digest& program);

/// Returns a script that lets the worker finish its bands (the rows that it is rendering) for at
/// most `drain_s` seconds, then ends it and removes the installation. It also succeeds if no worker
/// is installed.
std::string dismiss_script(int drain_s);

}  // namespace bandsaw::coordinator
