#pragma once

// Standard output and standard error, and what is known of the terminal behind them.

#include <functional>
#include <string>

#include "absl/strings/string_view.h"
#include "coordinator/cli/base/exit_code.h"

namespace bandsaw::coordinator {

struct TerminalSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

/// From now on writing where nobody reads any more does not end the process: for commands that
/// leave a file. Others end with their reader.
void outlive_reader();

class Console {
 public:
  using Write = std::function<void(absl::string_view)>;

  /// For tests: what is written goes to the functions; `is_terminal` and `colour` as told.
  Console(Write out, Write err, bool is_terminal, bool colour);

  /// This process's own. A terminal: standard output is one and TERM is not "dumb". Colour: that,
  /// and NO_COLOR is not set (no-color.org).
  static Console standard();

  bool is_terminal() const { return is_terminal_; }
  bool colour() const { return colour_; }
  /// Asked anew each time: windows change.
  TerminalSize size() const;

  /// As it is, at once.
  void write(absl::string_view text) const { out_(text); }
  /// With a line end.
  void line(absl::string_view text) const;

  /// "bandsaw: text" on standard error, on one line whatever the text holds.
  void complain(absl::string_view text) const;
  /// The same, and returns `code`.
  ExitCode fail(ExitCode code, absl::string_view text) const;

 private:
  Write out_;
  Write err_;
  bool is_terminal_;
  bool colour_;
};

}  // namespace bandsaw::coordinator
