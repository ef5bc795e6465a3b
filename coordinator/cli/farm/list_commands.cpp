// The commands `bandsaw jobs`, `workers` and `logs`, which query the farm and print the answer, and
// ShowText (--help, --version, `completion`), which only prints a text.

#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/lists_text.h"
#include "coordinator/cli/options/commands.h"
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

absl::Status show_log(const LogsOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const std::vector<std::string> lines, client->logs(options.worker));
  if (options.verbosity.json) {
    console.line(log_json(options.worker, lines));
    return absl::OkStatus();
  }
  for (const std::string& line : lines) {
    console.line(printable(line));
  }
  return absl::OkStatus();
}

}  // namespace

ExitCode run(const JobsOptions& options, Process& process) {
  return finished(list_jobs(options, process.console), process.console);
}

ExitCode run(const WorkersOptions& options, Process& process) {
  return finished(list_workers(options, process.console), process.console);
}

ExitCode run(const LogsOptions& options, Process& process) {
  return finished(show_log(options, process.console), process.console);
}

ExitCode run(const ShowText& options, Process& process) {
  process.console.write(options.text);
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
