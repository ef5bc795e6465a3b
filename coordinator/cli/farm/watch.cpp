// bandsaw watch: follows an existing job.

#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

ExitCode run(const WatchOptions& options, Process& process) {
  if (const auto status = check_outputs_writable(options.outputs); !status.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  if (options.denoise != Denoiser::kNone) {
    if (const auto status = check_outputs_writable(raw_outputs(options.outputs)); !status.ok()) {
      return process.console.fail(ExitCode::kWrong, std::string(status.message()));
    }
  }
  const auto reports = report_files(options.report, options.outputs);
  if (!reports.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(reports.status().message()));
  }
  const auto client = connect_to_farm(options.farm);
  if (!client.ok()) {
    return process.console.fail(exit_code_of(client.status()),
                                std::string(client.status().message()));
  }
  return watch_job(**client, options.job,
                   {options.outputs, *reports, options.display, options.tev, options.denoise},
                   options.verbosity, process);
}

}  // namespace bandsaw::coordinator
