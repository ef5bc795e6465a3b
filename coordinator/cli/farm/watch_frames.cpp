// watch_frames() follows the sequence by follow_job(). At each change of the frames' states, a
// FrameFetcher fetches the images of the frames that are done.

#include "coordinator/cli/farm/watch_frames.h"

#include "absl/strings/str_cat.h"
#include "coordinator/cli/farm/after_job.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/frame_fetcher.h"
#include "coordinator/cli/farm/watch_job.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/output_names.h"
#include "coordinator/cli/progress/progress_display.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Follows the job until it is over, and fetches frames at each change. Returns the last status.
/// UNAVAILABLE: the farm did not come back. CANCELLED: a signal came. Other errors: those of
/// FrameFetcher::update().
absl::StatusOr<Progress> follow(FarmClient& client, JobId job, FrameFetcher& fetcher,
                                ProgressDisplay& display) {
  FrameCounts known;
  absl::Status failed;
  const auto on_status = [&](const Progress& progress) {
    if (progress.job.frames == known) {
      return;
    }
    const absl::Status status = fetcher.update();
    if (status.ok()) {
      known = progress.job.frames;
    } else if (!absl::IsUnavailable(status)) {
      failed = status;
      client.stop();
    }
  };
  auto last = follow_job(client, job, display, on_status);
  RETURN_IF_ERROR(failed);
  RETURN_IF_ERROR(last.status());
  RETURN_IF_ERROR(fetcher.fetch_rest());
  return last;
}

}  // namespace

absl::Status check_frame_files(const WatchOptions& options) {
  std::vector<std::string> numbered = options.outputs;
  if (!options.report.file.empty() && options.report.file != "none") {
    numbered.push_back(options.report.file);
  }
  for (const std::string& name : numbered) {
    if (!has_frame_place(name)) {
      return absl::InvalidArgumentError(
          absl::StrCat(name,
                       ": each frame needs a file of its own; put #### where its number is "
                       "to be, as in walk.####.exr"));
    }
  }
  RETURN_IF_ERROR(check_outputs_writable(options.outputs));
  if (options.denoise != Denoiser::kNone) {
    RETURN_IF_ERROR(check_raw_outputs(options.outputs));
  }
  if (!options.after.contact_sheet.empty()) {
    RETURN_IF_ERROR(check_outputs_writable({options.after.contact_sheet}));
  }
  return options.after.video.empty() ? absl::OkStatus() : Video::check(options.after.video);
}

WatchedFrames watch_frames(FarmClient& client, const WatchOptions& options, Process& process) {
  const JobId job = options.job;
  const Console& console = process.console;
  ProgressDisplay display(console, options.verbosity);
  FrameFetcher fetcher(client, options, display, console);
  const Interrupts::Listener listener(process.interrupts, [&] {
    client.stop();
    fetcher.stop();
  });
  // The sentence with the command by which the user follows the job again.
  const std::string how = come_back(options, "NAME.####.png");
  const auto last = follow(client, job, fetcher, display);
  if (!last.ok()) {
    display.clear();
    const std::string otherwise =
        absl::StrCat(last.status().message(), "; the farm keeps the images. ", how);
    return {left_early(last.status(), job, how, otherwise, console), /*is_over=*/false};
  }
  const absl::Status made = fetcher.make_collections();
  if (absl::IsCancelled(made) || absl::IsUnavailable(made)) {
    display.clear();
    return {console.fail(
                exit_code_of(made),
                absl::StrCat(made.message(), "; job ", job,
                             " is over, but its video or contact sheet is not complete. ", how)),
            /*is_over=*/true};
  }
  std::vector<std::string> outputs = options.outputs;
  for (const std::string& file : {options.after.contact_sheet, options.after.video}) {
    if (!file.empty()) {
      outputs.push_back(file);
    }
  }
  ExitCode code = ExitCode::kDone;
  if (last->job.state != JobState::kDone) {
    display.ended(*last);
    const std::string reason = last->job.reason.empty() ? "" : absl::StrCat(": ", last->job.reason);
    code = console.fail(ExitCode::kFailed,
                        absl::StrCat("job ", job, " ", state_name(last->job.state), reason));
  }
  if (!made.ok()) {
    display.clear();
    code = console.fail(ExitCode::kFailed, std::string(made.message()));
  } else if (code == ExitCode::kDone) {
    display.done(*last, outputs, {});
  }
  code = run_after(options, client, outputs, fetcher.files(), code, process);
  return {code, /*is_over=*/true};
}

}  // namespace bandsaw::coordinator
