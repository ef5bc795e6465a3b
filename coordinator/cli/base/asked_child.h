#pragma once

// A child process that gets lines on its standard input and answers each with a line on its
// standard output.

#include <sys/types.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/base/child_process.h"

namespace bandsaw::coordinator {

class AskedChild {
 public:
  /// Starts `arguments[0]` (a path, or a name on PATH) without a shell. Its standard error is
  /// discarded unless `errors_too` is set. Lines that do not begin with `prefix` are no answers,
  /// but part of the output. The system's error if it could not be started.
  static absl::StatusOr<std::unique_ptr<AskedChild>> start(
      const std::vector<std::string>& arguments, const std::string& prefix = "",
      bool errors_too = false);
  /// Kills a child that has not ended.
  ~AskedChild();
  AskedChild(const AskedChild&) = delete;
  AskedChild& operator=(const AskedChild&) = delete;

  /// Sends a line, and returns the next answer; both without their ends. If the child ended
  /// instead, or was killed because `seconds` have passed or `stop` was set, returns how; it MUST
  /// NOT be asked again then. `stop` may be nullptr; it is polled every 20 ms.
  std::variant<std::string, ChildOutcome> ask(const std::string& line, double seconds,
                                              const std::atomic<bool>* stop);

 private:
  AskedChild(pid_t pid, int stream, std::string prefix)
      : pid_(pid), stream_(stream), prefix_(std::move(prefix)) {}
  ChildOutcome killed(ChildOutcome::End why);
  /// Returns how the child exited; std::nullopt: it runs.
  std::optional<ChildOutcome> exited();
  std::optional<std::string> next_answer();

  pid_t pid_;
  const int stream_;  ///< both ways
  bool open_ = true;  ///< the child has not closed its end of the stream
  const std::string prefix_;
  std::string received_;  ///< beyond the last line
  std::string skipped_;   ///< lines that are no answers, at most 64 KiB
};

}  // namespace bandsaw::coordinator
