#pragma once

// A coprocess is a child process that reads lines from its standard input and answers each with a
// line on its standard output. The importer and Blender are coprocesses while the frames of an
// animation are read, one line for each frame.

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
  /// discarded; with `errors_too` it is read as if it were standard output. Output lines that do
  /// not begin with `prefix` are not answers; they are only kept for ChildOutcome::output. Returns
  /// the system's error if the child cannot be started.
  static absl::StatusOr<std::unique_ptr<Coprocess>> start(const std::vector<std::string>& arguments,
                                                          const std::string& prefix = "",
                                                          bool errors_too = false);
  /// Kills a child that has not ended.
  ~Coprocess();
  Coprocess(const Coprocess&) = delete;
  Coprocess& operator=(const Coprocess&) = delete;

  /// Sends a line and returns the child's answer, both without line ends. Kills the child if it has
  /// not answered after `seconds`, or when another thread sets `stop`. `stop` may be nullptr; it is
  /// polled every 20 ms. Returns the outcome if the child exits before it answers, or if it was
  /// killed. After that, exchange() MUST NOT be called again.
  std::variant<std::string, ChildOutcome> exchange(const std::string& line, double seconds,
                                                   const std::atomic<bool>* stop);

 private:
  Coprocess(pid_t pid, int stream, std::string prefix)
      : pid_(pid), stream_(stream), prefix_(std::move(prefix)) {}
  /// Kills the child, waits for its end and returns the outcome.
  ChildOutcome killed(ChildOutcome::End why);
  /// Returns how the child exited; std::nullopt: it still runs.
  std::optional<ChildOutcome> exited();
  /// Removes the next answer from `received_`; std::nullopt: it has not arrived.
  std::optional<std::string> next_answer();

  pid_t pid_;
  const int stream_;  ///< socket: the child's standard input and output
  bool open_ = true;  ///< the child has not closed its end of the stream
  const std::string prefix_;
  std::string received_;  ///< bytes of the child that next_answer() has not yet examined
  std::string skipped_;   ///< lines that are no answers, at most the last 64 KiB
};

}  // namespace bandsaw::coordinator
