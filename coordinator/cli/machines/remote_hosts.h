#pragma once

// Scripts on many machines at once, by the ssh of this one.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

/// What became of one machine.
struct RemoteOutcome {
  std::string host;  ///< as given: HOST, USER@HOST or an ssh:// address
  bool ok = false;
  std::string what;  ///< one line, printable
};

/// A script (remote_scripts.h) and what it reads from standard input, held once in memory for any
/// number of hosts.
class RemoteScript {
 public:
  /// The error is the system's.
  static absl::StatusOr<RemoteScript> create(const std::string& script,
                                             const std::string& input = "");

  /// Runs it on `host` for at most `seconds`; ends soon after `stop` is set. ssh never asks: a host
  /// that wants a password or is not known yet has an error that says so. May be called from
  /// several threads at once.
  RemoteOutcome run(const std::string& host, double seconds, const std::atomic<bool>& stop) const;

 private:
  RemoteScript(File file, std::size_t script_size)
      : file_(std::move(file)), script_size_(script_size) {}
  File file_;  // without a name: the script, then the input
  std::size_t script_size_;
};

/// Calls `work` for each host, 32 at a time from several threads, and `tell` as each ends, one at a
/// time. Returns when all have ended.
void for_each_host(const std::vector<std::string>& hosts,
                   const std::function<RemoteOutcome(const std::string& host)>& work,
                   const std::function<void(const RemoteOutcome&)>& tell);

}  // namespace bandsaw::coordinator
