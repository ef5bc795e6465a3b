#pragma once

// Standard output and standard error, and the properties of the terminal.

#include <functional>
#include <string>

#include "absl/strings/string_view.h"
#include "coordinator/cli/base/exit_code.h"

namespace bandsaw::coordinator {

struct TerminalSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

/// Ignores SIGPIPE, so that writing to a closed pipe no longer ends the process. Called by commands
/// that write a file; other commands may end when their reader ends.
void outlive_reader();

class Console {
 public:
  using Write = std::function<void(absl::string_view)>;

  /// For tests: output is passed to the functions.
  Console(Write out, Write err, bool is_terminal, bool colour);

  /// Returns the process's own console. It is a terminal if standard output is one and TERM is not
  /// "dumb". It has colour if it is a terminal and NO_COLOR is not set (no-color.org).
  static Console standard();

  bool is_terminal() const { return is_terminal_; }
  bool colour() const { return colour_; }
  /// Returns the terminal's present size: windows are resized.
  TerminalSize size() const;

  /// Writes the text unchanged and unbuffered.
  void write(absl::string_view text) const { out_(text); }
  /// Writes the text and a line end.
  void line(absl::string_view text) const;

  /// Writes "bandsaw: text" to standard error, on one line even if the text contains line ends.
  void complain(absl::string_view text) const;
  /// Calls complain() and returns `code`.
  ExitCode fail(ExitCode code, absl::string_view text) const;

 private:
  Write out_;
  Write err_;
  bool is_terminal_;
  bool colour_;
};

}  // namespace bandsaw::coordinator
