// run_child() starts a program with its output in a pipe, or in a file of the caller. Every 20 ms
// it tests whether the program has ended. If it still runs when the time is over or the caller has
// set `stop`, it is killed.

#include "coordinator/cli/base/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>

#include "absl/cleanup/cleanup.h"
#include "coordinator/cli/base/spawn.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

using Clock = std::chrono::steady_clock;

struct Child {
  pid_t pid = -1;
  int output = -1;  ///< read end of the pipe with its output; -1: there is no pipe
};

// Starts the program. Its output goes to the file descriptor in `streams`. If there is none, the
// output goes to a pipe, whose read end is Child::output.
absl::StatusOr<Child> start(const std::vector<std::string>& arguments,
                            const ChildStreams& streams) {
  if (streams.output >= 0) {
    ASSIGN_OR_RETURN(const pid_t pid, spawn(arguments, {.input_file = streams.input,
                                                        .output = streams.output,
                                                        .errors = STDERR_FILENO}));
    return Child{pid};
  }
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) {
    return errno_status(errno, "cannot make a pipe");
  }
  const absl::StatusOr<pid_t> pid = spawn(arguments, {.input_file = streams.input,
                                                      .output = ends[1],
                                                      .errors = streams.errors_too ? ends[1] : -1});
  close(ends[1]);
  if (!pid.ok()) {
    close(ends[0]);
    return pid.status();
  }
  return Child{*pid, ends[0]};
}

// Reads the child's output until the child has ended. Kills the child after `seconds`, or when
// `stop` is set. When this returns, the child has ended and was waited for.
ChildOutcome wait_for(const Child& child, double seconds, const std::atomic<bool>* stop) {
  constexpr int kLookEveryMs = 20;
  constexpr std::size_t kMaxOutput = 64 << 10;  // bounds memory; further output is read and dropped
  ChildOutcome outcome;
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  bool open = child.output >= 0;
  while (waitpid(child.pid, &outcome.wait_status, WNOHANG) == 0) {
    const bool stopped = stop != nullptr && stop->load();
    if (stopped || Clock::now() >= deadline) {
      outcome.end = stopped ? ChildOutcome::End::kStopped : ChildOutcome::End::kTimedOut;
      kill(child.pid, SIGKILL);
      waitpid(child.pid, &outcome.wait_status, 0);
      break;
    }
    pollfd ready{open ? child.output : -1, POLLIN, 0};
    // A child that has closed its pipe usually exits at once, so the next look comes after 1 ms.
    if (poll(&ready, 1, open || child.output < 0 ? kLookEveryMs : 1) > 0) {
      std::array<char, 4096> buffer{};
      const ssize_t got = read(child.output, buffer.data(), buffer.size());
      open = got > 0;
      outcome.output.append(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
      outcome.output.resize(std::min(outcome.output.size(), kMaxOutput));
    }
  }
  // Reads what is left in the pipe. Processes that the child started may keep the pipe open after
  // the child's end; they are not waited for.
  pollfd left{child.output, POLLIN, 0};
  std::array<char, 4096> rest{};
  while (outcome.output.size() < kMaxOutput && poll(&left, 1, 0) > 0) {
    const ssize_t got = read(child.output, rest.data(), rest.size());
    if (got <= 0) {
      break;
    }
    outcome.output.append(rest.data(), static_cast<std::size_t>(got));
  }
  outcome.output.resize(std::min(outcome.output.size(), kMaxOutput));
  return outcome;
}

}  // namespace

absl::StatusOr<ChildOutcome> run_child(const std::vector<std::string>& arguments, double seconds,
                                       const std::atomic<bool>* stop, const ChildStreams& streams) {
  ASSIGN_OR_RETURN(const Child child, start(arguments, streams));
  const absl::Cleanup close_output = [&child] {
    if (child.output >= 0) {
      close(child.output);
    }
  };
  return wait_for(child, seconds, stop);
}

}  // namespace bandsaw::coordinator
