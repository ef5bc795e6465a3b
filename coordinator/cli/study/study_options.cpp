#include "coordinator/cli/study/study_options.h"

#include <limits>

#include "coordinator/cli/options/admin_options.h"
#include "coordinator/cli/options/quantities.h"
#include "coordinator/cli/study/study_outputs.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint64_t kMaxStudySamples = 65'536;
constexpr std::uint64_t kMaxSeeds = 1'000;
constexpr std::uint64_t kMaxRuns = 10'000;

absl::StatusOr<Command> checked_phone_study(const RawOptions& raw) {
  if (raw.samples || raw.seeds || raw.seed || raw.reference_samples || raw.every_object) {
    return absl::InvalidArgumentError(
        "study --phone: samples and seeds are the phone study's; it takes --runs, --width and "
        "--threads");
  }
  PhoneStudyOptions options;
  options.images = raw.scenes;
  if (!raw.outputs.empty()) {
    options.outputs = raw.outputs;
  }
  RETURN_IF_ERROR(check_study_outputs(options.outputs));
  options.farm.farm = raw.farm;
  options.verbosity.quiet = raw.quiet;
  RETURN_IF_ERROR(read_whole("--runs", raw.runs, 1, kMaxRuns, options.runs));
  RETURN_IF_ERROR(read_whole("--width", raw.width, 1, kMaxSide, options.width));
  RETURN_IF_ERROR(
      read_whole("--threads", raw.threads, 1, wire::kThreadsPerWorker, options.threads));
  return options;
}

}  // namespace

void add_study(CLI::App& app, RawOptions& raw) {
  app.add_option("scenes", raw.scenes,
                 "Scene files (.textproto, .json) or model files; with --phone: how the names of "
                 "its images begin, as in objects [default: all]");
  app.add_flag("--phone", raw.phone,
               "Instead: time the 23 images of a study of ray tracing on phones (gallery/study) on "
               "one thread, on all, and on the farm if there is one");
  app.add_option("-o,--output", raw.outputs,
                 "File for the figures (.csv) or the plot (.svg); may be repeated "
                 "[default: study.csv and study.svg; phone.csv and phone.svg]")
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--samples", raw.samples,
                 "The most samples a pixel; 1, 4, 16, … come before [default: 64]")
      ->type_name("N");
  app.add_option("--seeds", raw.seeds, "Images of each kind, to average over [default: 4]")
      ->type_name("K");
  app.add_option("--reference", raw.reference_samples,
                 "Samples of the image that is compared with [default: 16 times --samples]")
      ->type_name("N");
  app.add_option("--seed", raw.seed, "The first seed [default: 0]")->type_name("N");
  app.add_option(
         "--width", raw.width,
         "Pixels; the height keeps the aspect ratio [default: 96; with --phone the study's]")
      ->type_name("W");
  app.add_option("--threads", raw.threads, "Threads [default: one for each CPU]")->type_name("N");
  app.add_option("--runs", raw.runs, "With --phone: how often each image is timed [default: 10]")
      ->type_name("N");
  add_farm(app, raw);
  app.add_flag("--every-object", raw.every_object,
               "Also test each ray against every object; small scenes only");
  app.add_flag("--quiet", raw.quiet, "Say only the table and errors");
}

absl::StatusOr<Command> checked_study(const RawOptions& raw) {
  if (raw.phone) {
    return checked_phone_study(raw);
  }
  if (raw.runs || !raw.farm.empty()) {
    return absl::InvalidArgumentError("study: --runs and --farm are for --phone");
  }
  StudyOptions options;
  options.scenes = raw.scenes;
  if (options.scenes.empty()) {
    return absl::InvalidArgumentError(
        "study: the scene is missing, as in: bandsaw study cornell.textproto");
  }
  if (!raw.outputs.empty()) {
    options.outputs = raw.outputs;
  }
  RETURN_IF_ERROR(check_study_outputs(options.outputs));
  options.every_object = raw.every_object;
  options.verbosity.quiet = raw.quiet;
  RETURN_IF_ERROR(read_whole("--samples", raw.samples, 4, kMaxStudySamples, options.samples));
  RETURN_IF_ERROR(read_whole("--seeds", raw.seeds, 1, kMaxSeeds, options.seeds));
  options.reference = 16 * options.samples;
  RETURN_IF_ERROR(read_whole("--reference", raw.reference_samples, 2 * options.samples, kMaxSamples,
                             options.reference));
  RETURN_IF_ERROR(
      read_whole("--seed", raw.seed, 0, std::numeric_limits<std::uint64_t>::max(), options.seed));
  RETURN_IF_ERROR(read_whole("--width", raw.width, 1, kMaxSide, options.width));
  RETURN_IF_ERROR(
      read_whole("--threads", raw.threads, 1, wire::kThreadsPerWorker, options.threads));
  return options;
}

}  // namespace bandsaw::coordinator
