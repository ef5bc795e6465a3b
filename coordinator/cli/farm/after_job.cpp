// run_after() runs the command of --then by a shell, once the job is over. The job's number, state
// and files are in the command's environment; the list of all files is in a temporary file.

#include "coordinator/cli/farm/after_job.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/base/atomic_file.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kNoLimit_s = 1e7;  // about 116 days

/// Returns the name of a new temporary file with these lines; empty: it could not be written.
std::string write_list(const std::vector<std::string>& files) {
  std::error_code error;
  std::string path =
      (std::filesystem::temp_directory_path(error) / "bandsaw-files-XXXXXX").string();
  const int file = error ? -1 : mkstemp(path.data());
  if (file < 0) {
    return "";
  }
  std::string text;
  for (const std::string& name : files) {
    absl::StrAppend(&text, name, "\n");
  }
  const bool good = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(file);
  if (!good) {
    std::remove(path.c_str());
    return "";
  }
  return path;
}

}  // namespace

ExitCode run_after(const std::string& command, FarmClient& client, JobId job,
                   const std::vector<std::string>& outputs, const std::vector<std::string>& files,
                   ExitCode code, const Console& console) {
  if (command.empty() || (code != ExitCode::kDone && code != ExitCode::kFailed)) {
    return code;
  }
  const auto last = client.job(job);
  if (!last.ok() || !is_final(last->job.state)) {
    return code;
  }
  const std::string list = write_list(files);
  const absl::Cleanup remove_list = [&list] { std::remove(list.c_str()); };
  const auto ran = run_child({"env", absl::StrCat("BANDSAW_JOB=", job),
                              absl::StrCat("BANDSAW_STATE=", state_name(last->job.state)),
                              absl::StrCat("BANDSAW_FILES=", absl::StrJoin(outputs, "\n")),
                              absl::StrCat("BANDSAW_FILE_LIST=", list), "sh", "-c", command},
                             kNoLimit_s, nullptr, {.errors_too = true});
  if (ran.ok()) {
    console.write(ran->output);
  }
  const bool good = ran.ok() && WIFEXITED(ran->wait_status) && WEXITSTATUS(ran->wait_status) == 0;
  if (!good) {
    return console.fail(
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
