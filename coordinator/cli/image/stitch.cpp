// The command `bandsaw stitch`: joins the parts (.band files) of an image that were rendered by
// `render --rows`.

#include <optional>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/part_file.h"
#include "coordinator/cli/image/report.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/image/stitch_coverage.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/progress/progress_text.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/film.h"

namespace bandsaw::coordinator {
namespace {

/// Joins the records of all parts into one image. Its film has the sums of the samples of every
/// pixel.
class Stitcher {
 public:
  /// Adds a record (some rows with the sums of their samples). `part`: its file, for errors.
  /// INVALID_ARGUMENT: the scene or the settings differ from those of the first record, or the
  /// samples were added before.
  absl::Status add(const std::string& part, const BandRecord& record) {
    if (!film_) {
      ASSIGN_OR_RETURN(film_, Film::create(record.settings.width, record.settings.height, ""));
      coverage_.emplace(record.settings.height);
      first_part_ = part;
      digest_ = record.package_digest;
      settings_ = record.settings;
    }
    if (record.package_digest != digest_) {
      return absl::InvalidArgumentError(
          absl::StrCat(part, " and ", first_part_,
                       " are parts of different scenes (the packages' digests differ)"));
    }
    if (!(record.settings == settings_)) {
      return absl::InvalidArgumentError(
          absl::StrCat(part, " and ", first_part_, " were rendered with different settings: ",
                       text(record.settings), " and ", text(settings_)));
    }
    RETURN_IF_ERROR(coverage_->add(part, record.pixels.band));
    counters_.add(record.pixels.counters);
    cpu_s_ += record.cpu_s;
    return film_->add(record.pixels);
  }

  /// Returns the status that a job would have if it had rendered the image in one run. Values that
  /// the parts do not have are unknown. INVALID_ARGUMENT: rows or samples are missing.
  absl::StatusOr<Progress> progress() const {
    ASSIGN_OR_RETURN(const std::uint64_t samples, coverage_->samples());
    Progress progress;
    JobView& job = progress.job;
    job.spec.manifest = digest_;
    job.spec.settings = settings_;
    job.spec.stop = StopAtSamples{samples};
    job.state = JobState::kDone;
    job.elapsed_s = -1;
    job.cpu_s = cpu_s_;
    job.samples_per_pixel = samples;
    job.samples_done = samples * settings_.width * settings_.height;
    job.counters = counters_;
    const auto error = film_->error();
    job.error = known_error(error, samples);
    if (job.error >= 0) {
      job.curve = {{samples, job.elapsed_s, job.cpu_s, *error}};
    }
    if (counters_.bad_samples > 0) {
      progress.bad_sample_at = bad_sample_text(counters_);
    }
    return progress;
  }

  Image image() const { return film_->snapshot().image; }

 private:
  static std::string text(const RenderSettings& settings) {
    return absl::StrCat(settings.width, "×", settings.height, " depth ", settings.max_depth,
                        " seed ", settings.seed, " by ", integrator_name(settings.integrator));
  }

  std::string first_part_;
  std::string digest_;
  RenderSettings settings_;
  std::optional<Film> film_;
  std::optional<StitchCoverage> coverage_;
  Counters counters_;
  double cpu_s_ = 0;
};

struct Stitched {
  Image image;
  Progress progress;
  Display display;  ///< display settings of the first part
};

/// Reads and joins the parts. Errors: those of Stitcher and of read_part().
absl::StatusOr<Stitched> stitched(const std::vector<std::string>& parts) {
  Stitcher stitcher;
  Stitched out;
  for (const std::string& part : parts) {
    ASSIGN_OR_RETURN(const Display display, read_part(part, [&](const BandRecord& record) {
                       return stitcher.add(part, record);
                     }));
    out.display = &part == &parts.front() ? display : out.display;
  }
  ASSIGN_OR_RETURN(out.progress, stitcher.progress());
  out.image = stitcher.image();
  return out;
}

}  // namespace

ExitCode run(const StitchOptions& options, Process& process) {
  if (const auto status = check_outputs_writable(options.outputs); !status.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  const auto reports = report_files(options.report, options.outputs);
  if (!reports.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(reports.status().message()));
  }
  const auto whole = stitched(options.parts);
  if (!whole.ok()) {
    const bool memory = absl::IsResourceExhausted(whole.status());
    return process.console.fail(memory ? ExitCode::kFailed : ExitCode::kWrong,
                                std::string(whole.status().message()));
  }
  const Image& image = whole->image;
  const Display display = options.display.over(whole->display);
  absl::Status status = write_outputs(image, options.outputs, display);
  if (status.ok()) {
    const Report report{whole->progress, pixels_sha256(image), options.outputs,
                        cut_off_values(image, options.outputs, display)};
    status = write_reports(report_text(report), *reports);
  }
  if (!status.ok()) {
    return process.console.fail(ExitCode::kFailed, std::string(status.message()));
  }
  for (const std::string& warning : warning_lines(whole->progress)) {
    process.console.complain(warning);
  }
  if (options.verbosity.json) {
    process.console.line(JsonObject()
                             .text("event", "done")
                             .texts("outputs", options.outputs)
                             .texts("reports", *reports)
                             .str());
  } else {
    process.console.line(
        absl::StrCat(printable_list(options.outputs), " · ", image.width, "×", image.height, " · ",
                     options.parts.size(), options.parts.size() == 1 ? " part" : " parts",
                     reports->empty() ? "" : " · report ", printable_list(*reports)));
  }
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
