// A Console writes to standard output and standard error. Colours are used only on a terminal, and
// only if the environment variable NO_COLOR is not set or is empty.

#include "coordinator/cli/base/console.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/text.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {
namespace {

// Writes the text to the file descriptor `fd`. Returns 0, or the errno of the write that failed.
int write_all(int fd, absl::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(fd, text.data(), text.size());
    if (n < 0 && errno != EINTR) {
      return errno;
    }
    text.remove_prefix(n > 0 ? static_cast<std::size_t>(n) : 0);
  }
  return 0;
}

// Returns true if the environment variable is set and not empty.
bool environment_has(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0';
}

}  // namespace

// If SIGPIPE is ignored, writing to a pipe whose reader has ended fails with EPIPE and does not end
// the process.
void outlive_reader() { std::signal(SIGPIPE, SIG_IGN); }

Console::Console(Write out, Write err, bool is_terminal, bool colour)
    : out_(std::move(out)), err_(std::move(err)), is_terminal_(is_terminal), colour_(colour) {}

Console Console::standard() {
  const char* term = std::getenv("TERM");
  const bool dumb = term == nullptr || absl::string_view(term) == "dumb";
  const bool tty = isatty(STDOUT_FILENO) == 1;
  const bool terminal = tty && !dumb;
  const auto error = std::make_shared<std::atomic<int>>(0);
  const auto out = [error, tty](absl::string_view text) {
    const int failed = write_all(STDOUT_FILENO, text);
    // EPIPE is not recorded: the reader of a pipe has ended. Errors of a terminal are not recorded
    // either, for example EIO: the terminal was closed.
    int none = 0;
    if (failed != 0 && failed != EPIPE && !tty) {
      error->compare_exchange_strong(none, failed);
    }
  };
  Console console(
      out, [](absl::string_view text) { write_all(STDERR_FILENO, text); }, terminal,
      terminal && !environment_has("NO_COLOR"));
  console.error_ = error;
  return console;
}

absl::Status Console::write_error() const {
  const int error = error_ == nullptr ? 0 : error_->load();
  return error == 0 ? absl::OkStatus() : errno_status(error, "standard output");
}

TerminalSize Console::size() const {
  winsize size{};
  if (is_terminal_ && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 &&
      size.ws_row > 0) {
    return {size.ws_col, size.ws_row};
  }
  return {};
}

void Console::line(absl::string_view text) const { out_(absl::StrCat(text, "\n")); }

void Console::complain(absl::string_view text) const {
  err_(absl::StrCat("bandsaw: ", printable(text), "\n"));
}

ExitCode Console::fail(ExitCode code, absl::string_view text) const {
  complain(text);
  return code;
}

}  // namespace bandsaw::coordinator
