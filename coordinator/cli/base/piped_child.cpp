// write() writes to a pipe, which is the child's standard input. The child's standard error is a
// file in memory, whose last line becomes the message if the child fails.

#include "coordinator/cli/base/piped_child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

#include "absl/strings/str_split.h"
#include "coordinator/cli/base/spawn.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

void close_if_open(int& descriptor) {
  if (descriptor >= 0) {
    close(descriptor);
    descriptor = -1;
  }
}

}  // namespace

absl::StatusOr<PipedChild> PipedChild::start(const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    return errno_status(errno, "cannot make a pipe");
  }
  PipedChild child(-1, ends[1], memfd_create("errors", MFD_CLOEXEC));
  const absl::StatusOr<pid_t> pid = spawn(arguments, {.input = ends[0], .errors = child.errors_});
  close(ends[0]);
  RETURN_IF_ERROR(pid.status());
  child.pid_ = *pid;
  return child;
}

PipedChild::PipedChild(PipedChild&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      input_(std::exchange(other.input_, -1)),
      errors_(std::exchange(other.errors_, -1)) {}

PipedChild::~PipedChild() {
  close_if_open(input_);
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close_if_open(errors_);
}

absl::Status PipedChild::write(absl::Span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(input_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written < 0) {
      return absl::AbortedError(last_error_line());
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

absl::Status PipedChild::finish() {
  close_if_open(input_);
  int status = 0;
  waitpid(std::exchange(pid_, -1), &status, 0);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? absl::OkStatus()
                                                       : absl::AbortedError(last_error_line());
}

std::string PipedChild::last_error_line() const {
  // Only the end of the file is read. The last line is expected to be shorter than kMaxBytes.
  constexpr std::size_t kMaxBytes = 4096;
  const off_t size = lseek(errors_, 0, SEEK_END);
  std::string text(kMaxBytes, '\0');
  const ssize_t got =
      pread(errors_, text.data(), text.size(),
            size > static_cast<off_t>(kMaxBytes) ? size - static_cast<off_t>(kMaxBytes) : 0);
  text.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  const std::vector<std::string> lines = absl::StrSplit(text, '\n', absl::SkipWhitespace());
  return lines.empty() ? "it ended without a message" : lines.back();
}

}  // namespace bandsaw::coordinator
