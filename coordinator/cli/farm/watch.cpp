// The command `bandsaw watch`: follows a job that was submitted before and fetches its image, or
// the images of its frames.

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/after_job.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/watch_frames.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {
namespace {

/// Watches a sequence, which is a job of many frames with the settings of `spec`.
ExitCode watch_sequence(const WatchOptions& options, const JobSpec& spec, FarmClient& client,
                        Process& process) {
  if (!options.tev.empty() || options.verbosity.preview) {
    return process.console.fail(
        ExitCode::kWrong, absl::StrCat("--preview and --tev are for one image: job ", options.job,
                                       " has frames; watch the job of one frame"));
  }
  absl::Status status = check_frame_files(options);
  // check_frame_files() returns FAILED_PRECONDITION if ffmpeg, which makes the video, is missing.
  const bool lacks_ffmpeg = absl::IsFailedPrecondition(status);
  status.Update(check_denoise(options.denoise, spec.settings, spec.stop));
  if (!status.ok()) {
    return process.console.fail(lacks_ffmpeg ? ExitCode::kFailed : ExitCode::kWrong,
                                std::string(status.message()));
  }
  return watch_frames(client, options, process).code;
}

/// Watches a job that renders a single image.
ExitCode watch_image(const WatchOptions& options, FarmClient& client, Process& process) {
  if (!options.after.video.empty() || !options.after.contact_sheet.empty()) {
    return process.console.fail(ExitCode::kWrong,
                                absl::StrCat("--video and --contact-sheet are made of frames: job ",
                                             options.job, " is a single image"));
  }
  if (options.denoise != Denoiser::kNone) {
    if (const auto status = check_raw_outputs(options.outputs); !status.ok()) {
      return process.console.fail(ExitCode::kWrong, std::string(status.message()));
    }
  }
  const auto reports = report_files(options.report, options.outputs);
  if (!reports.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(reports.status().message()));
  }
  const ExitCode code = watch_job(client, options, *reports, process);
  std::vector<std::string> files = options.outputs;
  files.insert(files.end(), reports->begin(), reports->end());
  return run_after(options, client, options.outputs, files, code, process);
}

}  // namespace

ExitCode run(const WatchOptions& options, Process& process) {
  // Ignores SIGPIPE, so that files are written even if the reader of standard output has ended.
  outlive_reader();
  const Console& console = process.console;
  if (const auto status = check_outputs_writable(options.outputs); !status.ok()) {
    return console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  const auto client = connect_to_farm(options.farm);
  if (!client.ok()) {
    return console.fail(exit_code_of(client.status()), std::string(client.status().message()));
  }
  const auto job = (*client)->job(options.job);
  if (!job.ok()) {
    return console.fail(exit_code_of(job.status()), std::string(job.status().message()));
  }
  return job->job.has_frames() ? watch_sequence(options, job->job.spec, **client, process)
                               : watch_image(options, **client, process);
}

}  // namespace bandsaw::coordinator
