// The commands `bandsaw cancel`, `pause`, `resume`, `priority` and `why`, which control or explain
// one job, and `bandsaw quarantine`, which excludes the machine of a worker or admits it again.

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/lists_text.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Prints the job's actual state, which may differ from the requested one: a job that is over
/// cannot be cancelled.
void print_state(const Progress& progress, Verbosity verbosity, const Console& console) {
  const JobView& job = progress.job;
  if (verbosity.json) {
    console.line(jobs_json({progress}).front());
    return;
  }
  console.line(absl::StrCat("job ", job.id, " is ", state_name(job.state), ", priority ",
                            job.priority, job.reason.empty() ? "" : ": ", printable(job.reason)));
}

absl::StatusOr<Progress> apply(FarmClient& client, const CancelOptions& options) {
  return client.cancel(options.job);
}
absl::StatusOr<Progress> apply(FarmClient& client, const PauseOptions& options) {
  return client.pause_job(options.job);
}
absl::StatusOr<Progress> apply(FarmClient& client, const ResumeOptions& options) {
  return client.resume_job(options.job);
}
absl::StatusOr<Progress> apply(FarmClient& client, const PriorityOptions& options) {
  return client.set_priority(options.job, options.priority);
}

/// Makes the change that the options stand for, and prints the job's state after it.
template <class Options>
absl::Status apply_and_print(const Options& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const Progress progress, apply(*client, options));
  print_state(progress, options.verbosity, console);
  return absl::OkStatus();
}

absl::Status print_why(const WhyOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const std::vector<std::string> reasons, client->why(options.job));
  for (const std::string& line :
       options.verbosity.json ? why_json(options.job, reasons) : reasons) {
    console.line(options.verbosity.json ? line : printable(line));
  }
  return absl::OkStatus();
}

absl::Status set_quarantine(const QuarantineOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  RETURN_IF_ERROR(client->quarantine(options.worker, options.lift));
  if (options.verbosity.json) {
    console.line(JsonObject()
                     .text("event", "quarantine")
                     .text("worker", options.worker)
                     .flag("lifted", options.lift)
                     .str());
  } else {
    console.line(absl::StrCat(printable(options.worker),
                              options.lift ? " may render again after its worker is restarted"
                                           : " gets no more work; its rows of unfinished jobs are "
                                             "rendered again"));
  }
  return absl::OkStatus();
}

}  // namespace

ExitCode run(const QuarantineOptions& options, Process& process) {
  return finished(set_quarantine(options, process.console), process.console);
}

ExitCode run(const CancelOptions& options, Process& process) {
  return finished(apply_and_print(options, process.console), process.console);
}

ExitCode run(const PauseOptions& options, Process& process) {
  return finished(apply_and_print(options, process.console), process.console);
}

ExitCode run(const ResumeOptions& options, Process& process) {
  return finished(apply_and_print(options, process.console), process.console);
}

ExitCode run(const PriorityOptions& options, Process& process) {
  return finished(apply_and_print(options, process.console), process.console);
}

ExitCode run(const WhyOptions& options, Process& process) {
  return finished(print_why(options, process.console), process.console);
}

}  // namespace bandsaw::coordinator
