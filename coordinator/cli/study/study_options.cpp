// Options of `bandsaw study`, and their checks.

#include <limits>

#include "coordinator/cli/options/add_options.h"
#include "coordinator/cli/options/quantities.h"
#include "coordinator/cli/study/study_outputs.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

// The largest numbers that --samples and --seeds accept.
constexpr std::uint64_t kMaxStudySamples = 65'536;
constexpr std::uint64_t kMaxSeeds = 1'000;

}  // namespace

void add_study(CLI::App& app, RawOptions& raw) {
  app.add_option("scenes", raw.scenes, "Scene files (.textproto, .json) or model files");
  app.add_option("-o,--output", raw.outputs,
                 "File for the figures (.csv) or the plot (.svg); may be repeated "
                 "[default: study.csv and study.svg]")
      ->allow_extra_args(false)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--samples", raw.samples,
                 "Maximum samples per pixel; 1, 4, 16, … are measured first [default: 64]")
      ->type_name("N");
  app.add_option("--seeds", raw.seeds,
                 "Number of seeds; each result is a mean over the images of all seeds [default: 4]")
      ->type_name("K");
  app.add_option("--reference", raw.reference_samples,
                 "Samples per pixel of the reference image, with which all others are compared "
                 "[default: 16 times --samples]")
      ->type_name("N");
  app.add_option("--seed", raw.seed, "The first seed [default: 0]")->type_name("N");
  app.add_option("--width", raw.width, "Pixels; the height keeps the aspect ratio [default: 96]")
      ->type_name("W");
  app.add_option("--threads", raw.threads, "Threads [default: one for each CPU]")->type_name("N");
  app.add_flag("--every-object", raw.every_object,
               "Also test each ray against every object; small scenes only");
  app.add_flag("--denoise", raw.compare_clean,
               "Compare each image with the same image after --denoise, and not techniques such as "
               "path guiding");
  app.add_flag("--quiet", raw.quiet, "Print only the table and errors");
}

absl::StatusOr<Command> checked_study(const RawOptions& raw) {
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
  options.denoise = raw.compare_clean;
  if (options.denoise && options.every_object) {
    return absl::InvalidArgumentError("--denoise and --every-object exclude each other");
  }
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
