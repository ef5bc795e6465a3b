#pragma once

// Runs scripts on many machines at the same time by ssh, for `bandsaw invite` and `dismiss`.

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

/// The result of a script on one machine.
struct RemoteOutcome {
  std::string host;  ///< as the user named it: HOST, USER@HOST or an ssh:// address; printable
  bool ok = false;   ///< the script ran and reported success
  std::string what;  ///< what the script reported, or the error; one line, printable
};

/// A script (remote_scripts.h) and its standard input. They are in memory once, however many hosts
/// they are sent to.
class RemoteScript {
 public:
  /// Writes the script and its input to a file in memory. Returns the system's error if that fails.
  static absl::StatusOr<RemoteScript> create(const std::string& script,
                                             const std::string& input = "");

  /// Runs the script on `host` for at most `seconds`; ends soon after `stop` is set. ssh asks no
  /// questions: if the host is unknown or wants a password, the outcome is an error. Thread-safe.
  RemoteOutcome run(const std::string& host, double seconds, const std::atomic<bool>& stop) const;

 private:
  RemoteScript(File file, std::size_t script_size)
      : file_(std::move(file)), script_size_(script_size) {}
  File file_;  // a file in memory with the script and, after it, the input
  std::size_t script_size_;
};

/// Calls `work` for each host, for up to 32 hosts at the same time, on threads of its own. Calls
/// `report` with each outcome, on these threads but one call at a time. Returns when all hosts are
/// done.
void for_each_host(const std::vector<std::string>& hosts,
                   const std::function<RemoteOutcome(const std::string& host)>& work,
                   const std::function<void(const RemoteOutcome&)>& report);

}  // namespace bandsaw::coordinator
