#pragma once

// A script on many machines at once, by the ssh of this one.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// What became of one machine.
struct RemoteOutcome {
  std::string host;  ///< as given: HOST, USER@HOST or an ssh:// address
  bool ok = false;
  std::string what;  ///< one line, printable
};

/// Runs `script` (remote_scripts.h) on every host, `input` on its standard input; 32 at a time,
/// each for at most `seconds`. ssh never asks: a host that wants a password or is not known yet has
/// an error that says so. `tell` is called as each ends, one at a time, from several threads.
/// Returns when all have ended; soon after `stop` is set. The error is the system's: nothing was
/// run.
absl::Status run_on_hosts(const std::vector<std::string>& hosts, const std::string& script,
                          const std::string& input, double seconds, const std::atomic<bool>& stop,
                          const std::function<void(const RemoteOutcome&)>& tell);

}  // namespace bandsaw::coordinator
