// The command `bandsaw submit --frames`. The scene of the first frame is imported before the
// sequence (a job of many frames) is started, so that an error in the scene is reported at once. A
// FrameSender sends the other scenes while watch_frames() fetches the images that are done.

#include "coordinator/cli/farm/submit_frames.h"

#include <algorithm>
#include <atomic>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/farm/frame_sender.h"
#include "coordinator/cli/farm/upload.h"
#include "coordinator/cli/farm/watch_frames.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/output_names.h"
#include "coordinator/cli/scene/image_settings.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "proto/convert/render_values.h"
#include "proto/link/random.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

absl::StatusOr<JobId> start_sequence(FarmClient& client, const SubmitOptions& options,
                                     const PackageInfo& scene, const RenderSettings& settings) {
  farm::SubmitSequenceRequest request;
  request.set_request_id(link::random_hex(16));
  request.set_name(scene.name);
  *request.mutable_settings() = bandsaw::to_message(settings);
  *request.mutable_stop() = to_message(options.image.stop);
  request.set_priority(options.priority);
  request.set_fixed_seed(options.image.fixed_seed);
  request.set_frames(frames_text(options.frames));
  return client.submit_sequence(request);
}

/// Returns those frames of the job `options.continued` that have no scene on the farm yet.
/// INVALID_ARGUMENT: the job has other frames than --frames names.
absl::StatusOr<std::vector<FrameNumber>> lacking(FarmClient& client, const SubmitOptions& options) {
  ASSIGN_OR_RETURN(const FarmClient::Frames known, client.frames(options.continued));
  std::vector<FrameNumber> all;
  std::vector<FrameNumber> out;
  for (const FrameView& frame : known.frames) {
    all.push_back(frame.number);
    if (frame.state == FrameState::kExpected) {
      out.push_back(frame.number);
    }
  }
  if (all != options.frames) {
    return absl::InvalidArgumentError(absl::StrCat("--continue: the frames of job ",
                                                   options.continued, " are ", frames_text(all),
                                                   ", not ", frames_text(options.frames)));
  }
  return out;
}

/// Checks the files of all frames before the job is started. Errors: those of check_frame_files()
/// (FAILED_PRECONDITION: ffmpeg, which makes the video, is missing) and, if the user named no
/// outputs, of check_default_output().
absl::Status check_files(const SubmitOptions& options, const WatchOptions& watch) {
  RETURN_IF_ERROR(check_frame_files(watch));
  if (!options.outputs.empty()) {
    return absl::OkStatus();
  }
  for (const std::string& output : watch.outputs) {
    for (const FrameNumber frame : options.frames) {
      RETURN_IF_ERROR(check_default_output(options.scene, name_of_frame(output, frame)));
    }
  }
  return absl::OkStatus();
}

/// A sequence that start() has started or continued.
struct Started {
  JobId job = 0;
  std::vector<FrameNumber> left;  ///< frames whose scenes are still to be sent
  absl::Status sent;              ///< result of sending the first scene, after the job was started
};

/// Starts or continues the sequence and sends its first scene. An error after the job was started
/// is in Started::sent. If the import or check_denoise() fails, sets `code` to the exit code;
/// otherwise `code` is unchanged.
absl::StatusOr<Started> start(FarmClient& client, const SubmitOptions& options,
                              FrameImporter& importer, Process& process, ExitCode& code) {
  Started started{options.continued, options.frames, absl::OkStatus()};
  if (options.continued != 0) {
    ASSIGN_OR_RETURN(started.left, lacking(client, options));
    if (started.left.empty()) {
      return started;
    }
  }
  auto package = importer.import(started.left.front(), options.verbosity, process);
  if (!package.ok()) {
    code = import_exit_code(package.status());
    return package.status();
  }
  ASSIGN_OR_RETURN(const RenderSettings settings, image_settings(options.image, package->info()));
  if (const auto status = check_denoise(options.denoise, settings, options.image.stop);
      !status.ok()) {
    code = ExitCode::kWrong;
    return status;
  }
  const Interrupts::Listener listener(process.interrupts, [&] { client.stop(); });
  ProgressDisplay display(process.console, options.verbosity);
  if (started.job == 0) {
    ASSIGN_OR_RETURN(started.job, start_sequence(client, options, package->info(), settings));
  }
  started.sent = send_frame(client, started.job, started.left.front(), *package, display);
  if (started.sent.ok()) {
    started.left.erase(started.left.begin());
  }
  return started;
}

void say_started(JobId job, Verbosity verbosity, const Console& console) {
  if (verbosity.json) {
    console.line(JsonObject().text("event", "submitted").whole("job", job).str());
  } else {
    console.line(absl::StrCat("job ", job));
  }
}

/// Prints why the scenes of `frames` were not sent. Unless the job is over (ABORTED), also names
/// the frames and the command that sends them. `status` is an error of the import or of the farm.
/// Returns import_exit_code(status). If that is kWrong, `status` may be an error of the farm, which
/// import_exit_code() does not know; then returns exit_code_of(status).
ExitCode not_sent(const absl::Status& status, JobId job, const std::vector<FrameNumber>& frames,
                  const Console& console) {
  const ExitCode code = import_exit_code(status) == ExitCode::kWrong ? exit_code_of(status)
                                                                     : import_exit_code(status);
  if (absl::IsAborted(status)) {
    return console.fail(code, std::string(status.message()));
  }
  return console.fail(
      code == ExitCode::kDone ? ExitCode::kFailed : code,
      absl::StrCat(
          status.message(), "; the scenes of the frames ", frames_text(frames),
          " were not sent, and the job waits for them; send them with the same command and "
          "--continue ",
          job));
}

}  // namespace

ExitCode submit_frames(FarmClient& client, const SubmitOptions& options, WatchOptions watch,
                       Process& process) {
  const Console& console = process.console;
  if (const absl::Status status = check_files(options, watch); !status.ok()) {
    return console.fail(absl::IsFailedPrecondition(status) ? ExitCode::kFailed : ExitCode::kWrong,
                        std::string(status.message()));
  }
  ExitCode code = ExitCode::kDone;
  FrameImporter importer(options.scene, options.image.choices);
  const auto started = start(client, options, importer, process, code);
  if (!started.ok()) {
    return console.fail(code == ExitCode::kDone ? exit_code_of(started.status()) : code,
                        std::string(started.status().message()));
  }
  if (!started->sent.ok()) {
    return not_sent(started->sent, started->job, started->left, console);
  }
  const auto import = [&](FrameNumber frame, const std::atomic<bool>& stop) {
    std::vector<std::string> warnings;  // not printed; start() has printed those of the first frame
    return importer.import(frame, stop, warnings);
  };
  FrameSender sender(client, console, started->job, started->left, import, [&] {
    if (!options.detach) {
      client.stop();  // ends the watch
    }
  });
  if (options.detach) {
    const Interrupts::Listener listener(process.interrupts, [&] { sender.stop(); });
    const absl::Status sent = sender.wait();
    say_started(started->job, options.verbosity, console);
    return sent.ok() ? ExitCode::kDone : not_sent(sent, started->job, sender.unsent(), console);
  }
  watch.job = started->job;
  const WatchedFrames watched = watch_frames(client, watch, process);
  sender.stop();
  const absl::Status sent = sender.wait();
  if (sent.ok() || watched.is_over) {
    return watched.code;
  }
  // The sender's error ends the watch with kInterrupted. With any other code the watch has ended by
  // itself, for example because a file could not be written, and the sender was stopped after it.
  code = not_sent(sent, started->job, sender.unsent(), console);
  return watched.code == ExitCode::kInterrupted ? code : watched.code;
}

}  // namespace bandsaw::coordinator
