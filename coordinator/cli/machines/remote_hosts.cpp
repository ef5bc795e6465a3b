#include "coordinator/cli/machines/remote_hosts.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <thread>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/machines/remote_scripts.h"
#include "renderlib/base/file.h"
#include "renderlib/base/mutex.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::size_t kAtOnce = 32;
constexpr int kSshFailed = 255;  // what ssh itself ends with

/// The script comes first on standard input, so that no shell on the way reads it; dd takes not a
/// byte more of it.
std::vector<std::string> ssh_command(const std::string& host, std::size_t script_size) {
  return {"ssh",
          "-T",
          "-C",
          "-o",
          "BatchMode=yes",
          "-o",
          "ConnectTimeout=10",
          "-o",
          "ServerAliveInterval=5",
          "-o",
          "ServerAliveCountMax=3",
          "--",
          host,
          absl::StrCat("exec sh -c 'eval \"$(dd bs=1 count=", script_size, " 2>/dev/null)\"'")};
}

/// A file without a name that holds the text; the caller closes it.
absl::StatusOr<int> file_in_memory(const std::string& text) {
  const int file = memfd_create("bandsaw-input", MFD_CLOEXEC);
  std::size_t done = 0;
  while (file >= 0 && done < text.size()) {
    const ssize_t wrote = write(file, text.data() + done, text.size() - done);
    if (wrote <= 0) {
      close(file);
      return errno_status(errno, "what is to be sent");
    }
    done += static_cast<std::size_t>(wrote);
  }
  return file >= 0 ? absl::StatusOr<int>(file) : errno_status(errno, "what is to be sent");
}

std::string last_line(const std::string& output) {
  std::string last = "no answer";
  for (const absl::string_view line : absl::StrSplit(output, '\n', absl::SkipWhitespace())) {
    last = printable(absl::StripSuffix(line, "\r"));
  }
  return last;
}

/// Whether the script said how it went.
bool read_result(const std::string& output, RemoteOutcome& outcome) {
  for (absl::string_view line : absl::StrSplit(output, '\n')) {
    if (absl::ConsumePrefix(&line, kRemoteResult)) {
      outcome.ok = absl::ConsumePrefix(&line, "ok ");
      absl::ConsumePrefix(&line, "failed ");
      outcome.what = printable(line);
      return true;
    }
  }
  return false;
}

RemoteOutcome judge(const std::string& host, const absl::StatusOr<ChildOutcome>& child,
                    double seconds) {
  RemoteOutcome outcome;
  outcome.host = printable(host);
  if (!child.ok()) {
    outcome.what = std::string(child.status().message());
  } else if (child->end == ChildOutcome::End::kStopped) {
    outcome.what = "interrupted";
  } else if (read_result(child->output, outcome)) {
    return outcome;
  } else if (child->end == ChildOutcome::End::kTimedOut) {
    outcome.what = absl::StrCat("did not end within ", duration(seconds));
  } else if (WIFEXITED(child->wait_status) && WEXITSTATUS(child->wait_status) == kSshFailed) {
    outcome.what = absl::StrCat("not reached: ", last_line(child->output));
    if (absl::StrContains(child->output, "Host key verification failed")) {
      absl::StrAppend(&outcome.what, " (connect once by hand: ssh ", outcome.host, ")");
    } else if (absl::StrContains(child->output, "Permission denied")) {
      absl::StrAppend(&outcome.what, " (a key is needed: ssh-copy-id ", outcome.host, ")");
    }
  } else {
    outcome.what = absl::StrCat("its shell gave up: ", last_line(child->output));
  }
  return outcome;
}

}  // namespace

absl::Status run_on_hosts(const std::vector<std::string>& hosts, const std::string& script,
                          const std::string& input, double seconds, const std::atomic<bool>& stop,
                          const std::function<void(const RemoteOutcome&)>& tell) {
  ASSIGN_OR_RETURN(const int file, file_in_memory(script + input));
  const absl::Cleanup close_file = [file] { close(file); };
  // Opened anew by each child, so that each reads from the beginning.
  const ChildStreams streams{.input = absl::StrCat("/proc/self/fd/", file), .errors_too = true};
  Mutex telling;
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < hosts.size(); i = next++) {
      const auto child = run_child(ssh_command(hosts[i], script.size()), seconds, &stop, streams);
      const RemoteOutcome outcome = judge(hosts[i], child, seconds);
      MutexLock lock(telling);
      tell(outcome);
    }
  };
  std::vector<std::jthread> threads(std::min(hosts.size(), kAtOnce));
  std::generate(threads.begin(), threads.end(), [&] { return std::jthread(work); });
  return absl::OkStatus();  // when the threads have ended
}

}  // namespace bandsaw::coordinator
