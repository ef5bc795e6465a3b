#pragma once

// Runs scripts on many machines at the same time by ssh.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

/// The result of one machine.
struct RemoteOutcome {
  std::string host;  ///< as given: HOST, USER@HOST or an ssh:// address
  bool ok = false;
  std::string what;  ///< one line, printable
};

/// A script (remote_scripts.h) and its standard input, held in memory once for any number of hosts.
class RemoteScript {
 public:
  /// Returns the system's error if the file with the input cannot be created.
  static absl::StatusOr<RemoteScript> create(const std::string& script,
                                             const std::string& input = "");

  /// Runs the script on `host` for at most `seconds`; ends soon after `stop` is set. ssh asks no
  /// questions: for a host that wants a password or is unknown the result is an error. Thread-safe.
  RemoteOutcome run(const std::string& host, double seconds, const std::atomic<bool>& stop) const;

 private:
  RemoteScript(File file, std::size_t script_size)
      : file_(std::move(file)), script_size_(script_size) {}
  File file_;  // without a name: the script, then the input
  std::size_t script_size_;
};

/// Calls `work` for each host, for up to 32 hosts at the same time from several threads, and
/// `report` with each result, one call at a time. Returns when all hosts are done.
void for_each_host(const std::vector<std::string>& hosts,
                   const std::function<RemoteOutcome(const std::string& host)>& work,
                   const std::function<void(const RemoteOutcome&)>& report);

}  // namespace bandsaw::coordinator
