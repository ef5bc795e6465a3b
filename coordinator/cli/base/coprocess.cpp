// One end of a socket pair is both the child's standard input and its standard output. exchange()
// writes a line to the other end. Then it reads until an answer (a line that begins with `prefix_`)
// has come, the child has exited, the time is over or the caller has set `stop`.

#include "coordinator/cli/base/coprocess.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <utility>

#include "coordinator/cli/base/spawn.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

// Writes all bytes to the socket. MSG_NOSIGNAL: if the child has ended, send() returns an error,
// and no SIGPIPE ends this process.
void send_all(int stream, const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t now = send(stream, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (now < 0 && errno != EINTR) {
      return;  // the child has ended, which exchange() notices when it reads
    }
    sent += static_cast<std::size_t>(now < 0 ? 0 : now);
  }
}

}  // namespace

absl::StatusOr<std::unique_ptr<Coprocess>> Coprocess::start(
    const std::vector<std::string>& arguments, const std::string& prefix, bool errors_too) {
  std::array<int, 2> ends{};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    return errno_status(errno, "cannot make a pair of sockets");
  }
  const absl::StatusOr<pid_t> pid =
      spawn(arguments, {.input = ends[1], .output = ends[1], .errors = errors_too ? ends[1] : -1});
  close(ends[1]);
  if (!pid.ok()) {
    close(ends[0]);
    return pid.status();
  }
  return std::unique_ptr<Coprocess>(new Coprocess(*pid, ends[0], prefix));
}

Coprocess::~Coprocess() {
  close(stream_);
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

ChildOutcome Coprocess::killed(ChildOutcome::End why) {
  ChildOutcome outcome{.end = why, .output = skipped_ + received_};
  kill(pid_, SIGKILL);
  waitpid(std::exchange(pid_, -1), &outcome.wait_status, 0);
  return outcome;
}

std::optional<ChildOutcome> Coprocess::exited() {
  ChildOutcome outcome{.output = skipped_ + received_};
  if (waitpid(pid_, &outcome.wait_status, WNOHANG) == 0) {
    return std::nullopt;
  }
  pid_ = -1;
  return outcome;
}

std::optional<std::string> Coprocess::next_answer() {
  constexpr std::size_t kMaxSkipped = 64 << 10;
  for (std::size_t end; (end = received_.find('\n')) != std::string::npos;) {
    std::string line = received_.substr(0, end);
    received_.erase(0, end + 1);
    if (line.compare(0, prefix_.size(), prefix_) == 0) {
      return line;
    }
    skipped_ += line + "\n";
    skipped_.erase(0, skipped_.size() - std::min(skipped_.size(), kMaxSkipped));
  }
  return std::nullopt;
}

std::variant<std::string, ChildOutcome> Coprocess::exchange(const std::string& line, double seconds,
                                                            const std::atomic<bool>* stop) {
  constexpr int kLookEveryMs = 20;
  send_all(stream_, line + "\n");
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    if (std::optional<std::string> answer = next_answer()) {
      return *std::move(answer);
    }
    if (!open_) {
      if (std::optional<ChildOutcome> outcome = exited()) {
        return *std::move(outcome);
      }
    }
    if (stop != nullptr && stop->load()) {
      return killed(ChildOutcome::End::kStopped);
    }
    if (Clock::now() >= deadline) {
      return killed(ChildOutcome::End::kTimedOut);
    }
    pollfd ready{open_ ? stream_ : -1, POLLIN, 0};
    // A child that has closed its end usually exits at once, so the next look comes after 1 ms.
    if (poll(&ready, 1, open_ ? kLookEveryMs : 1) > 0) {
      std::array<char, 4096> buffer{};
      const ssize_t got = read(stream_, buffer.data(), buffer.size());
      open_ = got > 0;
      received_.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    }
  }
}

}  // namespace bandsaw::coordinator
