// Each checked_X() converts the options of command X from the texts that the user typed
// (RawOptions) to plain values, or returns the first error as INVALID_ARGUMENT. The other
// functions check options that several commands have, or groups of options.

#include "coordinator/cli/options/checked_options.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/options/choices.h"
#include "coordinator/cli/options/output_names.h"
#include "coordinator/cli/options/quantities.h"
#include "coordinator/scheduler/api/frame_numbers.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {
namespace {

absl::Status wrong(const std::string& message) { return absl::InvalidArgumentError(message); }

/// Checks that the suffix of each output names an image format. `parts_allowed`: .band files, which
/// have the sums of some rows (render --rows), are allowed as well.
absl::Status check_outputs(const std::vector<std::string>& outputs, bool parts_allowed) {
  for (const std::string& output : outputs) {
    if (parts_allowed && is_part_name(output)) {
      continue;
    }
    if (is_part_name(output)) {
      return wrong(
          absl::StrCat("-o ", output, ": a .band part is made by: bandsaw render --rows y0:y1"));
    }
    RETURN_IF_ERROR(image_format_of(output).status());
  }
  return absl::OkStatus();
}

/// Returns the rule that ends the job: --samples, --error or --time; 64 samples if none is given.
absl::StatusOr<StopRule> checked_stop(const RawOptions& raw) {
  if (raw.samples.has_value() + raw.error.has_value() + raw.time.has_value() > 1) {
    return wrong("--samples, --error and --time exclude each other: give one");
  }
  if (raw.adaptive && !raw.error) {
    return wrong(
        "--adaptive needs --error: with --samples and --time all pixels get the same number of "
        "samples");
  }
  if (raw.error) {
    ASSIGN_OR_RETURN(const double error, parse_percent("--error", *raw.error));
    return StopAtError{.relative_rmse = error, .adaptive = raw.adaptive};
  }
  if (raw.time) {
    ASSIGN_OR_RETURN(const double seconds, parse_seconds("--time", *raw.time));
    return StopAtTime{.seconds = seconds};
  }
  if (raw.samples) {
    ASSIGN_OR_RETURN(const std::uint64_t samples,
                     parse_whole("--samples", *raw.samples, 1, kMaxSamples));
    return StopAtSamples{samples};
  }
  return ImageOptions().stop;
}

/// Reads the number in `text`, which must be above 0, into `value`. If `text` has no value,
/// `value` is unchanged. The number must be below 1e9, so that a size in GB fits into 64 bits when
/// it is converted to bytes.
absl::Status read_positive(const char* name, const std::optional<std::string>& text,
                           double& value) {
  if (text && (!absl::SimpleAtod(*text, &value) || !(value > 0 && value < 1e9))) {
    return wrong(absl::StrCat(name, ": must be a number above 0, is '", *text, "'"));
  }
  return absl::OkStatus();
}

/// Reads --frame, --fps and --shutter. They determine at which time a scene that moves is rendered.
/// Also checks --frames and --fixed-seed against --frame.
absl::Status read_frame(const RawOptions& raw, SceneChoices& choices) {
  if (raw.frame && raw.frames) {
    return wrong("--frame and --frames exclude each other");
  }
  if (raw.fixed_seed && !raw.frame && !raw.frames) {
    return wrong("--fixed-seed needs --frame or --frames");
  }
  if (raw.frame) {
    FrameNumber frame = 0;
    // Both bounds are compared, because the least integer has no absolute value.
    if (!absl::SimpleAtoi(*raw.frame, &frame) || frame > kMaxFrameNumber ||
        frame < -kMaxFrameNumber) {
      return wrong(absl::StrCat("--frame: must be a whole number in [", -kMaxFrameNumber, ", ",
                                kMaxFrameNumber, "], is '", *raw.frame, "'"));
    }
    choices.frame = frame;
  }
  // Reads a number in [low, high] into `to`, which becomes std::nullopt without `text`. The option
  // is refused if the command line selects no frames.
  const auto read = [&](const char* name, const std::optional<std::string>& text, double low,
                        double high, std::optional<double>& to) -> absl::Status {
    double value = 0;
    if (text && !raw.frame && !raw.frames && !raw.video) {
      return wrong(absl::StrCat(name, " needs --frame or --frames"));
    }
    if (text && (!absl::SimpleAtod(*text, &value) || !(value >= low && value <= high))) {
      return wrong(
          absl::StrCat(name, ": must be a number in [", low, ", ", high, "], is '", *text, "'"));
    }
    to = text ? std::optional(value) : std::nullopt;
    return absl::OkStatus();
  };
  RETURN_IF_ERROR(read("--fps", raw.fps, 0.01, 10'000, choices.fps));
  return read("--shutter", raw.shutter, 0, 1, choices.shutter);
}

/// Returns the options that override the scene, such as --camera and --frame.
absl::StatusOr<SceneChoices> checked_choices(const RawOptions& raw) {
  for (const std::string& parameter : raw.parameters) {
    const std::size_t equals = parameter.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return wrong(absl::StrCat("-D: must be NAME=VALUE, is '", parameter, "'"));
    }
  }
  SceneChoices choices{raw.environment, raw.camera, raw.parameters,
                       raw.strict,      raw.folder, raw.inside};
  choices.animation = raw.animation;
  RETURN_IF_ERROR(read_frame(raw, choices));
  return choices;
}

/// With --frame, replaces #### in the names of the outputs and of the report by the number of the
/// frame.
void number_files(const SceneChoices& choices, std::vector<std::string>& outputs,
                  ReportOption& report) {
  if (!choices.frame) {
    return;
  }
  for (std::string& output : outputs) {
    output = name_of_frame(output, *choices.frame);
  }
  report.file = name_of_frame(report.file, *choices.frame);
}

/// Returns the options that determine the image: the scene's choices, the stop rule, size and
/// others.
absl::StatusOr<ImageOptions> checked_image(const RawOptions& raw) {
  ImageOptions image;
  ASSIGN_OR_RETURN(image.choices, checked_choices(raw));
  ASSIGN_OR_RETURN(image.stop, checked_stop(raw));
  RETURN_IF_ERROR(
      read_whole("--seed", raw.seed, 0, std::numeric_limits<std::uint64_t>::max(), image.seed));
  RETURN_IF_ERROR(read_whole("--width", raw.width, 1, kMaxSide, image.width));
  RETURN_IF_ERROR(read_whole("--height", raw.height, 1, kMaxSide, image.height));
  RETURN_IF_ERROR(read_whole("--depth", raw.depth, 1, kMaxDepth, image.depth));
  image.fixed_seed = raw.fixed_seed;
  if (raw.integrator) {
    image.integrator = integrator_named(*raw.integrator);
    if (!image.integrator) {
      return wrong_choice("--integrator", *raw.integrator);
    }
  }
  return image;
}

/// Returns the values of --exposure, --tone and --half.
absl::StatusOr<DisplayOptions> checked_display(const RawOptions& raw) {
  DisplayOptions display;
  display.half = raw.half;
  if (raw.exposure) {
    double stops = 0;
    if (!absl::SimpleAtod(*raw.exposure, &stops) || !(std::abs(stops) <= kMaxExposure)) {
      return wrong(absl::StrCat("--exposure: must be a number in [-", kMaxExposure, ", ",
                                kMaxExposure, "], is '", *raw.exposure, "'"));
    }
    display.exposure = stops;
  }
  if (raw.tone) {
    display.tone = tone_named(*raw.tone);
    if (!display.tone) {
      return wrong_choice("--tone", *raw.tone);
    }
  }
  return display;
}

/// Checks that a scene is given. `command` and `example` are used in the error.
absl::Status check_scene(const RawOptions& raw, const std::string& command,
                         const std::string& example = "cornell.textproto") {
  if (raw.scene.empty()) {
    return wrong(
        absl::StrCat(command, ": the scene is missing, as in: bandsaw ", command, " ", example));
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_address(const std::string& option, const std::string& address,
                           const std::string& example) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) {
    return wrong(
        absl::StrCat(option, ": must be HOST:PORT, as in ", example, ", is '", address, "'"));
  }
  return parse_whole(option + ": the port", address.substr(colon + 1), 0, 65535).status();
}

absl::StatusOr<Verbosity> checked_verbosity(const RawOptions& raw) {
  if (raw.quiet && raw.json) {
    return wrong("--quiet and --json exclude each other");
  }
  if (raw.preview && (raw.quiet || raw.json || raw.detach)) {
    return wrong("--preview draws on the terminal: --quiet, --json and --detach exclude it");
  }
  if (raw.preview && raw.rows) {
    return wrong("--preview shows a whole image while it forms: --rows excludes it");
  }
  return Verbosity{.quiet = raw.quiet, .json = raw.json, .preview = raw.preview};
}

absl::StatusOr<std::string> checked_tev(const RawOptions& raw) {
  if (!raw.tev) {
    return "";
  }
  if (raw.detach || raw.rows) {
    return wrong("--tev shows a whole image while it forms: --detach and --rows exclude it");
  }
  RETURN_IF_ERROR(check_address("--tev", *raw.tev, "127.0.0.1:14158"));
  return *raw.tev;
}

absl::StatusOr<std::vector<FrameNumber>> checked_frames(const RawOptions& raw) {
  if (!raw.frames) {
    return std::vector<FrameNumber>{};
  }
  auto frames = parse_frames(*raw.frames);
  if (!frames.ok()) {
    return wrong(absl::StrCat("--frames: ", frames.status().message()));
  }
  return frames;
}

absl::StatusOr<AfterOptions> checked_after(const RawOptions& raw) {
  AfterOptions after;
  after.video = raw.video.value_or("");
  after.contact_sheet = raw.contact_sheet.value_or("");
  after.command = raw.then.value_or("");
  constexpr const char* kContainers[] = {".mp4", ".mov", ".mkv", ".webm"};
  if (raw.video && std::none_of(std::begin(kContainers), std::end(kContainers), [&](auto suffix) {
        return absl::EndsWithIgnoreCase(after.video, suffix);
      })) {
    return wrong(
        absl::StrCat("--video: must end in .mp4, .mov, .mkv or .webm, is '", after.video, "'"));
  }
  if (raw.contact_sheet) {
    RETURN_IF_ERROR(check_outputs({after.contact_sheet}, /*parts_allowed=*/false));
  }
  if (raw.then && after.command.empty()) {
    return wrong("--then: the command is missing, as in: --then './send.sh'");
  }
  if (raw.fps && (!absl::SimpleAtod(*raw.fps, &after.video_fps) ||
                  !(after.video_fps >= 0.01 && after.video_fps <= 10'000))) {
    return wrong(absl::StrCat("--fps: must be a number in [0.01, 10000], is '", *raw.fps, "'"));
  }
  return after;
}

absl::Status check_frame_places(const std::vector<std::string>& outputs) {
  for (const std::string& output : outputs) {
    if (!has_frame_place(output)) {
      return wrong(absl::StrCat("-o ", output,
                                ": each frame needs a file of its own; put #### where its number "
                                "is to be, as in walk.####.exr"));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<JobId> checked_job(const RawOptions& raw, const std::string& command) {
  if (!raw.job) {
    return wrong(
        absl::StrCat(command, ": the job's number is missing; bandsaw jobs lists the numbers"));
  }
  return parse_whole("job", *raw.job, 1, std::numeric_limits<JobId>::max());
}

absl::StatusOr<Command> checked_serve(const RawOptions& raw) {
  ServeOptions options;
  options.data = raw.data;
  options.insecure = raw.insecure;
  options.reflection = raw.reflection;
  if (raw.listen) {
    options.listen = *raw.listen;
  }
  RETURN_IF_ERROR(check_address("--listen", options.listen, "0.0.0.0:7878"));
  ASSIGN_OR_RETURN(options.web, checked_web(raw));
  ASSIGN_OR_RETURN(options.audit_share, checked_share("--audit", raw.audit, options.audit_share));
  ASSIGN_OR_RETURN(options.browser_audit_share, checked_share("--browser-audit", raw.browser_audit,
                                                              options.browser_audit_share));
  ASSIGN_OR_RETURN(options.browsers, checked_browsers(raw));
  RETURN_IF_ERROR(read_positive("--keep-days", raw.keep_days, options.keep_days));
  RETURN_IF_ERROR(read_positive("--keep-size", raw.keep_size, options.keep_gb));
  RETURN_IF_ERROR(read_whole("--keep-jobs", raw.keep_jobs, 1, 1'000'000, options.keep_jobs));
  return options;
}

/// Returns the layers of --layers; none: not given. INVALID_ARGUMENT: a name is wrong, or no output
/// is an EXR file of a whole image.
absl::StatusOr<std::vector<LayerKind>> checked_layers(const RawOptions& raw) {
  if (!raw.layers) {
    return std::vector<LayerKind>{};
  }
  const auto is_exr = [](const std::string& name) {
    return absl::EndsWithIgnoreCase(name, ".exr");
  };
  if (raw.rows || std::none_of(raw.outputs.begin(), raw.outputs.end(), is_exr)) {
    return wrong("--layers: only EXR files of whole images have layers; add -o FILE.exr");
  }
  return parse_layers(*raw.layers);
}

/// Returns the method by which images are cleaned. INVALID_ARGUMENT: an unknown method.
absl::StatusOr<Denoiser> checked_denoise(const RawOptions& raw) {
  if (raw.denoise.empty()) {
    return Denoiser::kNone;
  }
  if (raw.denoise != "regression" && raw.denoise != "oidn") {
    return wrong_choice("--denoise", raw.denoise);
  }
  return raw.denoise == "oidn" ? Denoiser::kOidn : Denoiser::kRegression;
}

/// Reads the options of `submit` for a sequence (a job of many frames): --frames, --continue, and
/// the options that take effect when the job is over. If --frames is given, checks that options for
/// single images are absent and that each output has a place for the number of a frame.
absl::Status read_sequence(const RawOptions& raw, SubmitOptions& options) {
  ASSIGN_OR_RETURN(options.frames, checked_frames(raw));
  ASSIGN_OR_RETURN(options.after, checked_after(raw));
  if (raw.continued) {
    if (options.frames.empty()) {
      return wrong("--continue needs --frames: name the frames of the job that is continued");
    }
    ASSIGN_OR_RETURN(options.continued, parse_whole("--continue", *raw.continued, 1,
                                                    std::numeric_limits<JobId>::max()));
  }
  if (options.frames.empty() && (raw.video || raw.contact_sheet)) {
    return wrong("--video and --contact-sheet are made of frames: add --frames, as in 1:48");
  }
  if (!options.frames.empty() && (raw.layers || raw.tev || raw.preview)) {
    return wrong("--layers, --tev and --preview are for a single image: omit --frames");
  }
  if (raw.detach && (raw.video || raw.contact_sheet || raw.then)) {
    return wrong(
        "--detach does not wait for the job's end: give --video, --contact-sheet and --then to "
        "bandsaw watch JOB");
  }
  return options.frames.empty() ? absl::OkStatus() : check_frame_places(options.outputs);
}

absl::StatusOr<Command> checked_submit(const RawOptions& raw) {
  SubmitOptions options;
  options.scene = raw.scene;
  options.outputs = raw.outputs;
  options.farm.farm = raw.farm;
  options.detach = raw.detach;
  RETURN_IF_ERROR(check_scene(raw, "submit"));
  ASSIGN_OR_RETURN(options.image, checked_image(raw));
  ASSIGN_OR_RETURN(options.display, checked_display(raw));
  ASSIGN_OR_RETURN(options.report, checked_report(raw, /*has_images=*/!raw.detach));
  number_files(options.image.choices, options.outputs, options.report);
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  ASSIGN_OR_RETURN(options.tev, checked_tev(raw));
  RETURN_IF_ERROR(check_outputs(options.outputs, /*parts_allowed=*/false));
  if (raw.priority) {
    ASSIGN_OR_RETURN(options.priority, checked_priority_value("--priority", *raw.priority));
  }
  ASSIGN_OR_RETURN(options.layers, checked_layers(raw));
  RETURN_IF_ERROR(read_sequence(raw, options));
  if (options.detach && !options.outputs.empty()) {
    return wrong(
        "--detach does not wait for the image: omit -o and fetch it with bandsaw watch JOB "
        "-o FILE");
  }
  ASSIGN_OR_RETURN(options.denoise, checked_denoise(raw));
  if (options.denoise != Denoiser::kNone &&
      std::holds_alternative<StopAtError>(options.image.stop)) {
    return wrong(
        "--denoise: on a farm --error is a target for the image as rendered, not for the clean "
        "one; "
        "give --samples or --time, or use bandsaw render");
  }
  if (options.detach && options.denoise != Denoiser::kNone) {
    return wrong(
        "--detach does not wait for the image: omit --denoise and give it to bandsaw watch JOB");
  }
  return options;
}

absl::StatusOr<Command> checked_watch(const RawOptions& raw) {
  WatchOptions options;
  options.outputs = raw.outputs;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.job, checked_job(raw, "watch"));
  ASSIGN_OR_RETURN(options.display, checked_display(raw));
  ASSIGN_OR_RETURN(options.report, checked_report(raw, /*has_images=*/!raw.outputs.empty()));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  ASSIGN_OR_RETURN(options.tev, checked_tev(raw));
  ASSIGN_OR_RETURN(options.after, checked_after(raw));
  RETURN_IF_ERROR(check_outputs(options.outputs, /*parts_allowed=*/false));
  ASSIGN_OR_RETURN(options.denoise, checked_denoise(raw));
  if (options.denoise != Denoiser::kNone && options.outputs.empty()) {
    return wrong("--denoise: there is no file for the clean image; add -o FILE");
  }
  return options;
}

absl::StatusOr<Command> checked_jobs(const RawOptions& raw) {
  JobsOptions options;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  return options;
}

absl::StatusOr<Command> checked_workers(const RawOptions& raw) {
  WorkersOptions options;
  options.farm.farm = raw.farm;
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  return options;
}

absl::StatusOr<Command> checked_render(const RawOptions& raw) {
  RenderOptions options;
  options.scene = raw.scene;
  options.outputs = raw.outputs;
  RETURN_IF_ERROR(check_scene(raw, "render"));
  ASSIGN_OR_RETURN(options.image, checked_image(raw));
  ASSIGN_OR_RETURN(options.display, checked_display(raw));
  ASSIGN_OR_RETURN(options.report, checked_report(raw));
  number_files(options.image.choices, options.outputs, options.report);
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  ASSIGN_OR_RETURN(options.tev, checked_tev(raw));
  RETURN_IF_ERROR(
      read_whole("--threads", raw.threads, 1, wire::kThreadsPerWorker, options.threads));
  ASSIGN_OR_RETURN(options.kernel, chosen_kernel(raw.kernel));
  RETURN_IF_ERROR(check_outputs(options.outputs, /*parts_allowed=*/raw.rows.has_value()));
  if (raw.rows) {
    ASSIGN_OR_RETURN(options.rows, parse_rows("--rows", *raw.rows));
    if (!std::holds_alternative<StopAtSamples>(options.image.stop)) {
      return wrong("--rows needs --samples: parts of one image must have equally many samples");
    }
  }
  ASSIGN_OR_RETURN(options.layers, checked_layers(raw));
  ASSIGN_OR_RETURN(options.denoise, checked_denoise(raw));
  if (options.denoise != Denoiser::kNone && raw.rows) {
    return wrong("--denoise: only whole images are cleaned; omit --rows");
  }
  return options;
}

absl::StatusOr<Command> checked_info(const RawOptions& raw) {
  InfoOptions options;
  options.scene = raw.scene;
  RETURN_IF_ERROR(check_scene(raw, "info"));
  ASSIGN_OR_RETURN(options.choices, checked_choices(raw));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  return options;
}

absl::StatusOr<Command> checked_import(const RawOptions& raw) {
  ImportOptions options;
  options.scene = raw.scene;
  options.force = raw.force;
  RETURN_IF_ERROR(check_scene(raw, "import", "kitchen.pbrt"));
  ASSIGN_OR_RETURN(options.choices, checked_choices(raw));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (raw.outputs.size() > 1) {
    return wrong("import: writes one scene file; give -o once");
  }
  options.output = raw.outputs.empty() ? "" : raw.outputs.front();
  if (!options.output.empty() && !absl::EndsWith(options.output, ".textproto")) {
    return wrong(absl::StrCat("import: -o must end in .textproto, is '", options.output, "'"));
  }
  return options;
}

absl::StatusOr<Command> checked_stitch(const RawOptions& raw) {
  StitchOptions options;
  options.parts = raw.parts;
  options.outputs = raw.outputs;
  ASSIGN_OR_RETURN(options.display, checked_display(raw));
  ASSIGN_OR_RETURN(options.report, checked_report(raw));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  if (options.parts.empty()) {
    return wrong(
        "stitch: the parts are missing, as in: bandsaw stitch top.band bottom.band -o image.png");
  }
  if (options.outputs.empty()) {
    return wrong(
        "stitch: the output is missing, as in: bandsaw stitch top.band bottom.band -o image.png");
  }
  RETURN_IF_ERROR(check_outputs(options.outputs, /*parts_allowed=*/false));
  return options;
}

absl::StatusOr<Command> checked_compare(const RawOptions& raw) {
  if (raw.image.empty() || raw.reference.empty()) {
    return wrong("compare: two images are needed, as in: bandsaw compare a.png reference.png");
  }
  CompareOptions options;
  options.image = raw.image;
  options.reference = raw.reference;
  options.outputs = raw.outputs;
  RETURN_IF_ERROR(check_outputs(options.outputs, /*parts_allowed=*/false));
  ASSIGN_OR_RETURN(options.verbosity, checked_verbosity(raw));
  return options;
}

}  // namespace bandsaw::coordinator
