#pragma once

// Commands write all text through a Console: to standard output, or to standard error. A Console
// also knows whether standard output is a terminal, and the terminal's size and colours.

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "coordinator/cli/base/exit_code.h"

namespace bandsaw::coordinator {

/// Size in characters. The defaults are used if standard output is no terminal.
struct TerminalSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

/// Ignores SIGPIPE, so that writing to a closed pipe no longer ends the process. `render`, `submit`
/// and `watch` call it: they must write the image even if the reader of their standard output has
/// ended. Other commands may end when that reader ends.
void outlive_reader();

class Console {
 public:
  using Write = std::function<void(absl::string_view)>;

  /// Makes a console for tests: it passes the text for standard output to `out` and the text for
  /// standard error to `err`.
  Console(Write out, Write err, bool is_terminal, bool colour);

  /// Returns the process's own console. It is a terminal if standard output is one and TERM is set
  /// to a word other than "dumb". It has colour if it is a terminal and NO_COLOR is not set or is
  /// empty (no-color.org).
  static Console standard();

  /// Returns the error of the first write to standard output that failed; OK if all succeeded. It
  /// is no error if the reader of a pipe has ended or the terminal was closed.
  absl::Status write_error() const;

  bool is_terminal() const { return is_terminal_; }
  bool colour() const { return colour_; }
  /// Asks the terminal for its size at every call, because its window can be resized.
  TerminalSize size() const;

  /// Writes the text to standard output, unchanged and unbuffered.
  void write(absl::string_view text) const { out_(text); }
  /// Writes the text and a line end to standard output.
  void line(absl::string_view text) const;

  /// Writes "bandsaw: text" to standard error, on one line even if the text contains line ends:
  /// control characters are replaced (printable in cli/base/text.h).
  void complain(absl::string_view text) const;
  /// Calls complain() and returns `code`, so that a command can end with `return fail(…)`.
  ExitCode fail(ExitCode code, absl::string_view text) const;

 private:
  std::shared_ptr<std::atomic<int>> error_;  ///< errno of the first failure; nullptr: not recorded
  Write out_;
  Write err_;
  bool is_terminal_;
  bool colour_;
};

}  // namespace bandsaw::coordinator
