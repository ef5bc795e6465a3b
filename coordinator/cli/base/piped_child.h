#pragma once

// Runs a child process whose standard input is a pipe to which this program writes. The child
// process is ffmpeg, which makes the video of a sequence (cli/image/video.h).

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw::coordinator {

class PipedChild {
 public:
  /// Starts `arguments[0]` (a path, or a name on PATH) without a shell. Its standard output is
  /// discarded. NOT_FOUND: there is no such program. REQUIRES: this process ignores SIGPIPE
  /// (outlive_reader() in cli/base/console.h).
  static absl::StatusOr<PipedChild> start(const std::vector<std::string>& arguments);
  /// Kills the child if finish() was not called.
  ~PipedChild();
  PipedChild(PipedChild&& other) noexcept;
  PipedChild& operator=(PipedChild&& other) = delete;

  /// Writes all bytes to the child's standard input; blocks while the child does not read. ABORTED:
  /// the child has closed its input; the message is the last line of its standard error.
  absl::Status write(absl::Span<const std::byte> bytes);
  /// Closes the child's input and waits until the child has ended. ABORTED: the child did not exit
  /// with 0; the message is the last line of its standard error.
  absl::Status finish();

 private:
  PipedChild(pid_t pid, int input, int errors) : pid_(pid), input_(input), errors_(errors) {}
  /// Returns the last line of the child's standard error, or a text that says that there is none.
  std::string last_error_line() const;

  pid_t pid_ = -1;
  int input_ = -1;   ///< write end of the pipe to the child's standard input
  int errors_ = -1;  ///< file in memory with the child's standard error
};

}  // namespace bandsaw::coordinator
