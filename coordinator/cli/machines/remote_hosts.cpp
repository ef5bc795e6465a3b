// Runs ssh for each host. ssh's standard input is a file in memory with the script and the script's
// own input. A shell on the host reads the script from its standard input and evaluates it. The
// script is in no command line, so the user's login shell on the host does not parse it.

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

constexpr std::size_t kAtOnce = 32;  // number of hosts at the same time
constexpr int kSshFailed = 255;      // exit status with which ssh reports its own errors

/// Returns the ssh command. On the host, dd reads exactly the bytes of the script from standard
/// input, so that the script can read the rest. ssh uses no terminal (-T), compresses (-C), never
/// asks (BatchMode), and gives up after 10 s without a connection or 15 s of silence.
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

/// Returns the last line that is not empty, made printable, or "no answer".
std::string last_line(const std::string& output) {
  std::string last = "no answer";
  for (const absl::string_view line : absl::StrSplit(output, '\n', absl::SkipWhitespace())) {
    last = printable(absl::StripSuffix(line, "\r"));
  }
  return last;
}

/// If the script has printed its result (a line that begins with kRemoteResult), stores it in
/// `outcome` and returns true.
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

/// Returns the outcome for a host. It follows from how ssh ended and from what it printed.
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
    outcome.what = absl::StrCat("its shell failed: ", last_line(child->output));
  }
  return outcome;
}

}  // namespace

absl::StatusOr<RemoteScript> RemoteScript::create(const std::string& script,
                                                  const std::string& input) {
  const int memory = memfd_create("bandsaw-input", MFD_CLOEXEC);
  if (memory < 0) {
    return errno_status(errno, "the data to be sent");
  }
  const absl::Cleanup close_memory = [memory] { close(memory); };
  ASSIGN_OR_RETURN(File file, File::open(absl::StrCat("/proc/self/fd/", memory), O_RDWR));
  for (const std::string& text : {script, input}) {
    RETURN_IF_ERROR(file.write(
        absl::MakeConstSpan(reinterpret_cast<const std::byte*>(text.data()), text.size())));
  }
  return RemoteScript(std::move(file), script.size());
}

RemoteOutcome RemoteScript::run(const std::string& host, double seconds,
                                const std::atomic<bool>& stop) const {
  // Each child opens the file itself, so that each reads from the beginning.
  const ChildStreams streams{.input = absl::StrCat("/proc/self/fd/", file_.fd()),
                             .errors_too = true};
  return judge(host, run_child(ssh_command(host, script_size_), seconds, &stop, streams), seconds);
}

void for_each_host(const std::vector<std::string>& hosts,
                   const std::function<RemoteOutcome(const std::string& host)>& work,
                   const std::function<void(const RemoteOutcome&)>& report) {
  Mutex reporting;
  std::atomic<std::size_t> next{0};
  const auto take_hosts = [&] {
    for (std::size_t i = next++; i < hosts.size(); i = next++) {
      const RemoteOutcome outcome = work(hosts[i]);
      MutexLock lock(reporting);
      report(outcome);
    }
  };
  std::vector<std::jthread> threads(std::min(hosts.size(), kAtOnce));
  std::generate(threads.begin(), threads.end(), [&] { return std::jthread(take_hosts); });
}

}  // namespace bandsaw::coordinator
