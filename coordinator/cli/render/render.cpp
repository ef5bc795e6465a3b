// The command `bandsaw render`: renders an image, or some rows of it, on this machine, without a
// farm.

#include <algorithm>
#include <atomic>
#include <thread>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/ticker.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/layers.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/image/part_file.h"
#include "coordinator/cli/image/report.h"
#include "coordinator/cli/image/report_file.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/options/output_names.h"
#include "coordinator/cli/progress/image_views.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/render/clean_preview.h"
#include "coordinator/cli/render/local_render.h"
#include "coordinator/cli/scene/image_settings.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/engine/clock.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::coordinator {
namespace {

// Returns the files that the user named, or the default one.
std::vector<std::string> outputs_of(const RenderOptions& options) {
  if (!options.outputs.empty()) {
    return options.outputs;
  }
  return {default_output(options.scene, options.rows ? absl::StrCat("-", options.rows->first, "-",
                                                                    options.rows->last, ".band")
                                                     : ".png")};
}

/// Writes the files of `render --rows`: the sums of the rows to .band files, and a picture of these
/// rows to all others. Returns the picture; it is empty if there are only .band files.
absl::StatusOr<Image> write_part_outputs(const std::vector<BandPixels>& bands, const JobSpec& spec,
                                         const RowRange& rows,
                                         const std::vector<std::string>& outputs,
                                         const Display& display) {
  std::vector<std::string> pictures;
  for (const std::string& output : outputs) {
    if (!is_part_name(output)) {
      pictures.push_back(output);
      continue;
    }
    std::vector<BandRecord> records;
    for (const BandPixels& band : bands) {
      records.push_back({spec.manifest, spec.settings, band});
    }
    RETURN_IF_ERROR(write_part(output, records, display));
  }
  if (pictures.empty()) {
    return Image{};
  }
  ASSIGN_OR_RETURN(Image image, image_of_part(bands, spec.settings, rows));
  RETURN_IF_ERROR(write_outputs(image, pictures, display));
  return image;
}

/// Renders one image, shows its progress and writes its files. `spec`: the job that would render it
/// on a farm. `picture`: the display settings.
class LocalRun {
 public:
  LocalRun(const RenderOptions& options, Process& process, JobSpec spec, const Display& picture,
           int threads)
      : options_(options),
        process_(process),
        spec_(std::move(spec)),
        rows_(options.rows.value_or(RowRange{0, spec_.settings.height})),
        pool_(threads),
        meter_(spec_, rows_, threads, clocks()),
        display_(process.console, options.verbosity),
        picture_(picture),
        views_(display_, options.display, options.tev, spec_.name) {}

  /// Renders the image, writes its files and returns the exit code. Call it once.
  ExitCode run(SceneDescription description, const std::vector<std::string>& outputs,
               const std::vector<std::string>& reports) {
    const Interrupts::Listener listener(process_.interrupts, [this] { stop_ = true; });
    const absl::Status rendered = render(std::move(description));
    Progress progress = meter_.progress(clocks());
    if (!rendered.ok()) {
      display_.clear();
      const ExitCode code = absl::IsCancelled(rendered)         ? ExitCode::kInterrupted
                            : absl::IsInvalidArgument(rendered) ? ExitCode::kWrong
                                                                : ExitCode::kFailed;
      return process_.console.fail(code, code == ExitCode::kInterrupted
                                             ? "interrupted; nothing was written"
                                             : std::string(rendered.message()));
    }
    progress.job.state = JobState::kDone;
    progress.job.fraction = 1;
    progress.job.remaining_s = 0;
    progress.clean_error = clean_ ? clean_->denoised.total.at_most() : -1;
    if (const absl::Status written = write(progress, outputs, reports); !written.ok()) {
      display_.clear();
      return process_.console.fail(ExitCode::kFailed, std::string(written.message()));
    }
    display_.done(progress, outputs, reports);
    return ExitCode::kDone;
  }

 private:
  /// Renders into image_, layers_ and clean_, or into bands_ with --rows.
  absl::Status render(SceneDescription description) {
    constexpr std::chrono::milliseconds kInterval{100};
    const Ticker ticker(kInterval, [this] {
      const LocalMeter::Clocks now = clocks();
      display_.update(meter_.progress(now), now.steady_s);
    });
    ASSIGN_OR_RETURN(const std::shared_ptr<const Scene> scene,
                     Scene::build(std::move(description), pool_, /*forced=*/{}, Traversal::kBvh,
                                  options_.kernel));
    LocalJob job{*scene, spec_.settings, pool_, stop_, meter_};
    if (options_.rows) {
      ASSIGN_OR_RETURN(bands_,
                       render_part(job, rows_, std::get<StopAtSamples>(spec_.stop).samples));
      return absl::OkStatus();
    }
    std::optional<CleanPreview> preview;
    if (options_.denoise != Denoiser::kNone) {
      // --error sets a target for the error of the clean image.
      job.error_of = [&](const Film& film, std::uint64_t samples) -> absl::StatusOr<double> {
        RETURN_IF_ERROR(clean(*scene, film, samples));
        return clean_->denoised.total.at_most();
      };
      if (options_.verbosity.preview) {
        preview.emplace(*scene, spec_.settings, pool_, stop_);
        display_.note(
            "the preview is denoised with rough guide images; the picture is denoised at the end");
      }
    }
    if (views_.any()) {
      job.grown = [&](const Film& film) { show(film, preview ? &*preview : nullptr); };
    }
    ASSIGN_OR_RETURN(const Film film, render_whole(job, spec_.stop));
    image_ = film.snapshot().image;
    views_.show(image_, picture_);
    const std::uint64_t samples = meter_.progress(clocks()).job.samples_per_pixel;
    SampleCounts counts;
    if (is_adaptive(spec_.stop)) {
      counts = [&] { return film.counts(); };
    }
    ASSIGN_OR_RETURN(layers_, make_layers(options_.layers, spec_.settings, samples,
                                          layer_renderer(*scene), counts));
    if (options_.denoise != Denoiser::kNone) {
      RETURN_IF_ERROR(clean(*scene, film, samples));
      views_.show(clean_->denoised.image, picture_);
    }
    return absl::OkStatus();
  }

  /// Returns a function that renders the scene with other settings.
  LayerRenderer layer_renderer(const Scene& scene) {
    return [this, &scene](const RenderSettings& settings,
                          std::uint64_t count) -> absl::StatusOr<Image> {
      ASSIGN_OR_RETURN(const RenderedImage layer,
                       render_image(scene, settings, count, pool_, stop_, /*progress=*/{},
                                    /*spill_folder=*/""));
      return layer.film.snapshot().image;
    };
  }

  /// Removes the noise of the image, whose pixels have `samples` samples, and stores the result in
  /// clean_. Does nothing if clean_ has the result for this number of samples already.
  absl::Status clean(const Scene& scene, const Film& film, std::uint64_t samples) {
    if (clean_ && clean_->samples == samples) {
      return absl::OkStatus();
    }
    clean_.reset();
    const Image mean = film.snapshot().image;
    ASSIGN_OR_RETURN(Denoised made,
                     make_clean({mean, film.first_part(), spec_, samples}, guides_of(scene),
                                options_.denoise, scene.kernel(), pool_));
    clean_ = Clean{std::move(made), samples};
    return absl::OkStatus();
  }

  /// Returns a function that renders the guides (images by which the denoiser finds edges). The
  /// guides are kept in guides_. They are used again at a later checkpoint, unless the number of
  /// further samples has changed (clean_jobs.h).
  JobRenderer guides_of(const Scene& scene) {
    return [this, render = one_by_one(layer_renderer(scene))](
               const std::vector<JobSpec>& jobs) -> absl::StatusOr<std::vector<Image>> {
      if (!guides_ || guides_->jobs != jobs) {
        ASSIGN_OR_RETURN(std::vector<Image> images, render(jobs));
        guides_ = Guides{jobs, std::move(images)};
      }
      return guides_->images;
    };
  }

  /// Shows the image, unless it was shown a short time ago, so that most time is spent on
  /// rendering. `clean`: makes the picture without noise; nullptr: the image is shown as rendered.
  void show(const Film& film, CleanPreview* clean) {
    constexpr double kInterval_s = 0.3;
    constexpr double kMaxShare = 0.05;  // share of the time that is spent on cleaning
    const double begin = steady_seconds();
    if (begin < show_at_) {
      return;
    }
    absl::StatusOr<std::optional<Image>> picture = std::optional<Image>();
    if (clean != nullptr && views_.most_side() > 0) {
      picture = clean->of(film, views_.most_side());
    }
    const double cleaned_in = steady_seconds() - begin;
    // If the clean picture failed, the render fails for the same reason and reports it.
    views_.show(picture.ok() && *picture ? **picture : film.snapshot().image, picture_);
    show_at_ = steady_seconds() + std::max(kInterval_s, cleaned_in / kMaxShare);
  }

  /// Writes the files of the image (with --rows, those of the rows) and the reports.
  absl::Status write(const Progress& progress, const std::vector<std::string>& outputs,
                     const std::vector<std::string>& reports) const {
    Image part;  // with --rows: the picture of the rows; empty: none was written
    if (options_.rows) {
      ASSIGN_OR_RETURN(part, write_part_outputs(bands_, spec_, rows_, outputs, picture_));
    } else {
      RETURN_IF_ERROR(
          clean_ ? write_clean_outputs(clean_->denoised, image_, outputs, picture_, layers_)
                 : write_outputs(image_, outputs, picture_, layers_));
    }
    Report report{progress, options_.rows ? "" : pixels_sha256(image_), outputs,
                  cut_off_values(options_.rows ? part : image_, outputs, picture_)};
    if (clean_) {
      report.clean = clean_report(clean_->denoised, options_.denoise, outputs);
    }
    return write_reports(report_text(report), reports);
  }

  const RenderOptions& options_;
  Process& process_;
  const JobSpec spec_;
  const RowRange rows_;
  Pool pool_;
  LocalMeter meter_;
  ProgressDisplay display_;
  const Display picture_;
  ImageViews views_;
  double show_at_ = 0;  ///< time of the next picture, in seconds of a steady clock
  std::atomic<bool> stop_{false};
  Image image_;    ///< as rendered
  Layers layers_;  ///< additional layers of EXR files
  struct Clean {
    Denoised denoised;
    std::uint64_t samples = 0;  ///< samples per pixel of the image that was cleaned
  };
  std::optional<Clean> clean_;  ///< the image without noise; std::nullopt: not made yet
  struct Guides {
    std::vector<JobSpec> jobs;  ///< the jobs that made the images
    std::vector<Image> images;
  };
  std::optional<Guides> guides_;   ///< std::nullopt: not rendered yet
  std::vector<BandPixels> bands_;  ///< the rows of --rows
};

}  // namespace

ExitCode run(const RenderOptions& options, Process& process) {
  // Ignores SIGPIPE, so that the image is written even if the reader of standard output has ended.
  outlive_reader();
  const Console& console = process.console;
  const std::vector<std::string> outputs = outputs_of(options);
  const auto reports =
      check_image_files(options.scene, options.outputs, outputs, options.denoise, options.report);
  if (!reports.ok()) {
    return console.fail(ExitCode::kWrong, std::string(reports.status().message()));
  }
  auto decoded =
      decode_scene_file(options.scene, options.verbosity, process, options.image.choices);
  if (!decoded.ok()) {
    return console.fail(import_exit_code(decoded.status()),
                        std::string(decoded.status().message()));
  }
  const auto settings = image_settings(options.image, decoded->info);
  if (!settings.ok()) {
    return console.fail(ExitCode::kWrong, std::string(settings.status().message()));
  }
  if (const auto status = check_denoise(options.denoise, *settings, options.image.stop);
      !status.ok()) {
    return console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  if (options.rows && options.rows->last > settings->height) {
    return console.fail(ExitCode::kWrong,
                        absl::StrCat("--rows: must end at or before ", settings->height,
                                     " (the image's height), is ", options.rows->last));
  }
  JobSpec spec;
  spec.name = decoded->info.name;
  spec.manifest = wire::sha256(decoded->manifest).hex();
  spec.settings = *settings;
  spec.stop = options.image.stop;
  const auto cpus = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  return LocalRun(options, process, spec, options.display.over(decoded->info.display),
                  options.threads > 0 ? options.threads : cpus)
      .run(std::move(decoded->scene), outputs, *reports);
}

}  // namespace bandsaw::coordinator
