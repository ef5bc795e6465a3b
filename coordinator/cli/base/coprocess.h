#pragma once

// A coprocess: a child process that reads lines from its standard input and answers each with a
// line on its standard output.

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

class Coprocess {
 public:
  /// Starts `arguments[0]` (a path, or a name on PATH) without a shell. Its standard error is
  /// discarded unless `errors_too` is set. Output lines that do not begin with `prefix` are
  /// not answers; ChildOutcome has them. Returns the system's error if the child cannot be started.
  static absl::StatusOr<std::unique_ptr<Coprocess>> start(const std::vector<std::string>& arguments,
                                                          const std::string& prefix = "",
                                                          bool errors_too = false);
  /// Kills a child that has not ended.
  ~Coprocess();
  Coprocess(const Coprocess&) = delete;
  Coprocess& operator=(const Coprocess&) = delete;

  /// Sends a line and returns the child's answer, both without line ends. If the child exits before
  /// it answers, or is killed because `seconds` have passed or `stop` was set, returns the outcome;
  /// then the object MUST NOT be used again. `stop` may be nullptr; it is polled every 20 ms.
  std::variant<std::string, ChildOutcome> exchange(const std::string& line, double seconds,
                                                   const std::atomic<bool>* stop);

 private:
  Coprocess(pid_t pid, int stream, std::string prefix)
      : pid_(pid), stream_(stream), prefix_(std::move(prefix)) {}
  ChildOutcome killed(ChildOutcome::End why);
  /// Returns how the child exited; std::nullopt: it runs.
  std::optional<ChildOutcome> exited();
  /// Removes the next answer from `received_`; std::nullopt: it has not arrived.
  std::optional<std::string> next_answer();

  pid_t pid_;
  const int stream_;  ///< socket: the child's standard input and output
  bool open_ = true;  ///< the child has not closed its end of the stream
  const std::string prefix_;
  std::string received_;  ///< bytes after the last whole line
  std::string skipped_;   ///< lines that are no answers, at most 64 KiB
};

}  // namespace bandsaw::coordinator
