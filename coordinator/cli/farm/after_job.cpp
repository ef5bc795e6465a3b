// run_after() runs the command of --then by a shell, once the job is over. The job's number, state
// and files are in the command's environment. A file in a temporary folder lists all files.

#include "coordinator/cli/farm/after_job.h"

#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cstddef>
#include <memory>
#include <span>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/store/scratch_folder.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kNoLimit_s = 1e7;  // time limit of the command: about 116 days

/// Writes the names to a new file in the folder, one a line, and returns the path of that file.
/// Returns "" if there is no folder, or if the file could not be written.
std::string write_list(const absl::StatusOr<std::unique_ptr<const ScratchFolder>>& folder,
                       const std::vector<std::string>& files) {
  if (!folder.ok()) {
    return "";
  }
  const std::string path = absl::StrCat((*folder)->path(), "/files");
  const std::string text = files.empty() ? "" : absl::StrCat(absl::StrJoin(files, "\n"), "\n");
  return write_file_atomically(path, std::as_bytes(std::span(text))).ok() ? path : "";
}

}  // namespace

ExitCode run_after(const WatchOptions& options, FarmClient& client,
                   const std::vector<std::string>& outputs, const std::vector<std::string>& files,
                   ExitCode code, Process& process) {
  const std::string& command = options.after.command;
  if (command.empty() || (code != ExitCode::kDone && code != ExitCode::kFailed)) {
    return code;
  }
  const auto last = client.job(options.job);
  if (!last.ok() || !is_final(last->job.state)) {
    return code;
  }
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  const auto folder = ScratchFolder::make("then");
  const std::string list = write_list(folder, files);
  const auto ran = run_child({"env", absl::StrCat("BANDSAW_JOB=", options.job),
                              absl::StrCat("BANDSAW_STATE=", state_name(last->job.state)),
                              absl::StrCat("BANDSAW_FILES=", absl::StrJoin(outputs, "\n")),
                              absl::StrCat("BANDSAW_FILE_LIST=", list), "sh", "-c", command},
                             kNoLimit_s, &stop,
                             {.output = options.verbosity.json ? STDERR_FILENO : STDOUT_FILENO});
  if (stop) {
    return process.console.fail(ExitCode::kInterrupted, "--then: the command was interrupted");
  }
  const bool good = ran.ok() && WIFEXITED(ran->wait_status) && WEXITSTATUS(ran->wait_status) == 0;
  if (!good) {
    return process.console.fail(
        ExitCode::kFailed,
        absl::StrCat("--then: the command failed",
                     ran.ok()
                         ? WIFEXITED(ran->wait_status)
                               ? absl::StrCat(" with exit status ", WEXITSTATUS(ran->wait_status))
                               : absl::StrCat(" with signal ", WTERMSIG(ran->wait_status))
                         : absl::StrCat(": ", ran.status().message())));
  }
  return code;
}

}  // namespace bandsaw::coordinator
