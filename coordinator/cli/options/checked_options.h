#pragma once

// RawOptions has the options as the user typed them. The function checked_X() checks the options of
// command X and converts them to plain values (cli/options/options.h). All errors are
// INVALID_ARGUMENT, with a message for the user.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// The texts of the options of all commands; a command uses some of the fields. If an option was
/// not given, its field is an empty string, an optional without a value, an empty list or false.
/// Most fields have the name of their option or argument. `outputs` is -o, `parameters` is -D,
/// `continued` is --continue, `time` is --time or --for, `reference_samples` is --reference, and
/// `compare_clean` is --denoise of `study`.
struct RawOptions {
  std::string scene, environment, camera, animation, image, reference, data, farm, join;
  std::optional<std::string> job, listen, priority, worker, action, role, keep_days, keep_size,
      keep_jobs;
  std::vector<std::string> outputs, parts, scenes, hosts;
  std::optional<std::string> samples, error, time, seed, width, height, depth, threads, kernel,
      rows;
  std::optional<std::string> integrator, exposure, tone, layers, report, seeds, reference_samples;
  std::optional<std::string> tev, frame, fps, shutter, frames, continued, video, contact_sheet,
      then;
  std::vector<std::string> parameters;
  std::string inside, folder;
  bool strict = false, force = false;
  std::optional<std::string> web, shell, audit, browser_audit, browsers;
  bool lift = false, adaptive = false, half = false, insecure = false, detach = false,
       quiet = false, json = false, preview = false, every_object = false, reflection = false,
       compare_clean = false, fixed_seed = false, revoke = false;
  std::string denoise;  ///< "regression" or another method; empty: not given
};

absl::StatusOr<Command> checked_serve(const RawOptions& raw);
absl::StatusOr<Command> checked_submit(const RawOptions& raw);
absl::StatusOr<Command> checked_watch(const RawOptions& raw);
absl::StatusOr<Command> checked_jobs(const RawOptions& raw);
absl::StatusOr<Command> checked_workers(const RawOptions& raw);
absl::StatusOr<Command> checked_cancel(const RawOptions& raw);
absl::StatusOr<Command> checked_pause(const RawOptions& raw);
absl::StatusOr<Command> checked_resume(const RawOptions& raw);
absl::StatusOr<Command> checked_priority(const RawOptions& raw);
absl::StatusOr<Command> checked_why(const RawOptions& raw);
absl::StatusOr<Command> checked_missing(const RawOptions& raw);
absl::StatusOr<Command> checked_retry(const RawOptions& raw);
absl::StatusOr<Command> checked_logs(const RawOptions& raw);
absl::StatusOr<Command> checked_quarantine(const RawOptions& raw);
absl::StatusOr<Command> checked_doctor(const RawOptions& raw);
absl::StatusOr<Command> checked_secret(const RawOptions& raw);
absl::StatusOr<Command> checked_link(const RawOptions& raw);
absl::StatusOr<Command> checked_render(const RawOptions& raw);
absl::StatusOr<Command> checked_info(const RawOptions& raw);
absl::StatusOr<Command> checked_import(const RawOptions& raw);
absl::StatusOr<Command> checked_stitch(const RawOptions& raw);
absl::StatusOr<Command> checked_compare(const RawOptions& raw);

// The following functions check options that several commands have.

absl::StatusOr<Verbosity> checked_verbosity(const RawOptions& raw);
/// Returns the file of --report. `has_images`: whether the command writes an image; if it writes
/// none, --report is an error.
absl::StatusOr<ReportOption> checked_report(const RawOptions& raw, bool has_images = true);
/// Returns HOST:PORT of --tev, the viewer that shows the image as it forms; empty: not given.
absl::StatusOr<std::string> checked_tev(const RawOptions& raw);
/// Returns the frames of --frames; none: not given.
absl::StatusOr<std::vector<FrameNumber>> checked_frames(const RawOptions& raw);
/// Checks the options that take effect when a job is over: --video, --contact-sheet and --then.
absl::StatusOr<AfterOptions> checked_after(const RawOptions& raw);
/// Checks that each name has a place for the number of a frame: a run of '#'.
absl::Status check_frame_places(const std::vector<std::string>& outputs);
/// Checks that `address` is HOST:PORT. `option` and `example` are used in the error.
absl::Status check_address(const std::string& option, const std::string& address,
                           const std::string& example);
/// Parses the share of the bands that are rendered twice, such as "1%", and returns it as a number
/// in [0, 1]. Returns `standard` if there is no text. `option` is used in the error. A band (some
/// rows of an image) is what a worker gets at once.
absl::StatusOr<double> checked_share(const std::string& option,
                                     const std::optional<std::string>& text, double standard);
/// Returns the value of --browsers; Browsers::kAlso: not given.
absl::StatusOr<Browsers> checked_browsers(const RawOptions& raw);
/// Returns HOST:PORT of the dashboard, or "none"; empty: not given.
absl::StatusOr<std::string> checked_web(const RawOptions& raw);
/// Returns the number of the job. `command` is used in the error.
absl::StatusOr<JobId> checked_job(const RawOptions& raw, const std::string& command);
/// Returns the priority in `text`, [-kMaxPriority, kMaxPriority]. `name` is used in the error.
absl::StatusOr<std::int32_t> checked_priority_value(const std::string& name,
                                                    const std::string& text);

}  // namespace bandsaw::coordinator
