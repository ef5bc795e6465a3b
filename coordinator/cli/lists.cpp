// bandsaw jobs, workers, cancel: one question to the farm, and the answer.

#include "absl/strings/str_cat.h"
#include "coordinator/cli/commands.h"
#include "coordinator/cli/farm_client.h"
#include "coordinator/cli/farm_errors.h"
#include "coordinator/cli/lists_text.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

absl::Status list_jobs(const JobsOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const std::vector<Progress> jobs, client->jobs());
  for (const std::string& line : options.verbosity.json ? jobs_json(jobs) : jobs_table(jobs)) {
    console.line(line);
  }
  return absl::OkStatus();
}

absl::Status list_workers(const WorkersOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const farm::ListWorkersReply reply, client->workers());
  for (const std::string& line :
       options.verbosity.json ? workers_json(reply) : workers_table(reply)) {
    console.line(line);
  }
  return absl::OkStatus();
}

absl::Status cancel_job(const CancelOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const Progress progress, client->cancel(options.job));
  if (options.verbosity.json) {
    console.line(jobs_json({progress}).front());
  } else {
    // A job that was over before is not cancelled: say what it is.
    console.line(absl::StrCat("job ", options.job, " is ", state_name(progress.job.state)));
  }
  return absl::OkStatus();
}

ExitCode finish(const absl::Status& status, const Console& console) {
  return status.ok() ? ExitCode::kDone
                     : console.fail(exit_code_of(status), std::string(status.message()));
}

}  // namespace

ExitCode run(const JobsOptions& options, Process& process) {
  return finish(list_jobs(options, process.console), process.console);
}

ExitCode run(const WorkersOptions& options, Process& process) {
  return finish(list_workers(options, process.console), process.console);
}

ExitCode run(const CancelOptions& options, Process& process) {
  return finish(cancel_job(options, process.console), process.console);
}

ExitCode run(const ShowText& options, Process& process) {
  process.console.write(options.text);
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
