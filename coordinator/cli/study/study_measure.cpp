// The class Study renders one scene by each method with increasing numbers of samples. The class
// Seeds accumulates the results of several seeds. power_of() fits a power law to the results.

#include "coordinator/cli/study/study_measure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/cpu_time.h"
#include "coordinator/cli/image/clean.h"
#include "coordinator/cli/image/comparison.h"
#include "coordinator/cli/study/study_adaptive.h"
#include "coordinator/cli/study/study_pixel_stops.h"
#include "coordinator/scheduler/api/error_curve.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/compare/error_metrics.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::coordinator {
namespace {

/// Fits "y ~ x^p" to the points with x, y > 0, by least squares in logarithms, and returns p.
/// Returns std::nullopt if these points do not have two different x. The bound 1e-12 is above the
/// rounding errors of `spread`.
inline std::optional<double> power_of(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [at, value] : points) {
    if (at > 0 && value > 0) {
      const double log_at = std::log(at), log_value = std::log(value);
      n += 1, x += log_at, y += log_value, xx += log_at * log_at, xy += log_at * log_value;
    }
  }
  const double spread = n * xx - x * x;
  return n < 2 || !(spread > 1e-12 * n * xx) ? std::nullopt
                                             : std::optional((n * xy - x * y) / spread);
}

// The reference is the mean of two images with these seeds: any numbers that are larger than the
// number of seeds, so that no other image has them.
constexpr std::uint64_t kReferenceSeeds[] = {0x5eed0fa1d, 0x2b992ddfa};

// Returns the mean over all pixels and channels.
double mean_of(const Image& image) {
  double sum = 0;
  for (const Rgb& pixel : image.pixels) {
    sum += double{pixel.r} + pixel.g + pixel.b;
  }
  return sum / (3 * static_cast<double>(image.pixels.size()));
}

/// Accumulates the results of images that differ only in their seeds. `mean`: the mean of the
/// reference over all pixels and channels.
class Seeds {
 public:
  Seeds(const Image& reference, double mean) : reference_(reference), mean_(mean) {}

  void add(const Image& image, double samples, double cpu_s, double rays) {
    const ErrorMetrics errors = error_metrics(image, reference_);
    const double bias = mean_ > 0 ? mean_of(image) / mean_ - 1 : 0;
    count_ += 1;
    sum_.samples += samples;
    sum_.relative_rmse += errors.relative_rmse * errors.relative_rmse;
    sum_.relative_mse += errors.relative_mse;
    sum_.bias += bias;
    bias_squares_ += bias * bias;
    sum_.cpu_s += cpu_s;
    sum_.rays += rays;
  }

  StudyPoint point() const {
    StudyPoint out;
    out.samples = sum_.samples / count_;
    out.relative_rmse = std::sqrt(sum_.relative_rmse / count_);
    out.relative_mse = sum_.relative_mse / count_;
    out.bias = sum_.bias / count_;
    // The variance over the seeds, divided by count_ - 1, is the squared standard error of the
    // mean.
    const double spread = bias_squares_ / count_ - out.bias * out.bias;
    out.bias_error = count_ > 1 ? std::sqrt(std::max(0.0, spread) / (count_ - 1)) : 0;
    out.cpu_s = sum_.cpu_s / count_;
    out.rays = sum_.rays / count_;
    return out;
  }

 private:
  const Image& reference_;
  double mean_;
  double count_ = 0;
  double bias_squares_ = 0;
  StudyPoint sum_;
};

/// Returns the integrator that renders as the method requires. `standard`: that of kFull.
Integrator integrator_of(Method method, Integrator standard) {
  switch (method) {
    case Method::kNoMis:
      return Integrator::kPathLights;
    case Method::kNoLights:
      return Integrator::kPathScattering;
    case Method::kNoGuiding:
      return Integrator::kPathPlain;
    case Method::kIndependent:
    case Method::kPixelStops:
      // Each sample has a seed of its own, and each seed would need a photon map of its own.
      return standard == Integrator::kPath ? Integrator::kPathPlain : standard;
    default:
      return standard;
  }
}

/// Measures one scene. make_reference() MUST be called before the other functions.
class Study {
 public:
  Study(const Scene& scene, const RenderSettings& settings, const StudyPlan& plan, Pool& pool,
        const std::atomic<bool>& stop)
      : scene_(scene), settings_(settings), plan_(plan), pool_(pool), stop_(stop) {}

  /// Renders the reference and returns its estimated error. The reference is the mean of two images
  /// of different seeds, each with half of the samples. They are independent, so the mean square of
  /// their differences from the reference is an unbiased estimate of its error.
  absl::StatusOr<double> make_reference() {
    std::vector<Image> halves;
    for (const std::uint64_t seed : kReferenceSeeds) {
      RenderSettings settings = settings_;
      settings.seed = settings_.seed ^ seed;
      ASSIGN_OR_RETURN(const RenderedImage rendered,
                       render_image(scene_, settings, (plan_.reference + 1) / 2, pool_, stop_,
                                    /*progress=*/{}, /*spill_folder=*/""));
      halves.push_back(rendered.film.snapshot().image);
    }
    reference_ = halves[0];
    for (std::size_t i = 0; i < reference_.pixels.size(); ++i) {
      reference_.pixels[i] = (halves[0].pixels[i] + halves[1].pixels[i]) * 0.5f;
    }
    mean_ = mean_of(reference_);
    reference_error_ = error_metrics(halves[0], reference_);
    return reference_error_.relative_rmse;
  }

  /// Measures images as rendered and the same images with their noise removed.
  absl::Status with_clean(StudyOfScene& out) {
    StudyLine raw{Method::kFull, {}};
    StudyLine clean{Method::kClean, {}};
    for (const std::uint64_t samples : study_samples(plan_.samples)) {
      if (samples < kMinCleanSamples) {
        continue;
      }
      Seeds of_raw(reference_, mean_);
      Seeds of_clean(reference_, mean_);
      CleanPoint point{.samples = static_cast<double>(samples)};
      for (std::uint64_t seed = 0; seed < plan_.seeds; ++seed) {
        RETURN_IF_ERROR(add_both(samples, settings_.seed + seed, of_raw, of_clean, point));
      }
      raw.points.push_back(of_raw.point());
      clean.points.push_back(of_clean.point());
      const auto without_reference = [&](double mse) {
        return std::max(0.0, mse - reference_error_.relative_mse);
      };
      point.raw_mse = without_reference(raw.points.back().relative_mse);
      point.clean_mse = without_reference(clean.points.back().relative_mse);
      point.raw_cpu_s = raw.points.back().cpu_s;
      point.clean_cpu_s = clean.points.back().cpu_s;
      point.raw_flip /= static_cast<double>(plan_.seeds);
      point.clean_flip /= static_cast<double>(plan_.seeds);
      out.clean.push_back(std::move(point));
    }
    out.lines = {std::move(raw), std::move(clean)};
    return absl::OkStatus();
  }

  /// Measures a method at all numbers of samples. `scene`: the scene, built as the method needs it.
  absl::StatusOr<StudyLine> line(Method method, const Scene& scene) {
    StudyLine line{method, {}};
    if (method == Method::kPixelStops) {
      return pixel_stops();
    }
    for (const std::uint64_t samples : study_samples(plan_.samples)) {
      Seeds seeds(reference_, mean_);
      for (std::uint64_t seed = 0; seed < plan_.seeds; ++seed) {
        RETURN_IF_ERROR(add_image(method, scene, samples, settings_.seed + seed, seeds));
      }
      line.points.push_back(seeds.point());
    }
    return line;
  }

  /// Returns true if an image so far used path guiding, photon maps or portals (openings through
  /// which the background lights a room).
  bool guides() const { return guides_; }

 private:
  // One sample, with which study_samples() begins, is too few for the filter (check_cleanable).
  static constexpr std::uint64_t kMinCleanSamples = 4;

  /// Renders one image, removes its noise, and adds both to the results.
  absl::Status add_both(std::uint64_t samples, std::uint64_t seed, Seeds& of_raw, Seeds& of_clean,
                        CleanPoint& point) {
    JobSpec spec;
    spec.settings = settings_;
    spec.settings.seed = seed;
    scene_.guiding().clear();  // the CPU time of each image includes its own training
    const double start = process_cpu_seconds();
    ASSIGN_OR_RETURN(const RenderedImage rendered,
                     render_image(scene_, spec.settings, samples, pool_, stop_, /*progress=*/{},
                                  /*spill_folder=*/""));
    const Image image = rendered.film.snapshot().image;
    const double raw_s = process_cpu_seconds() - start;
    auto rays = static_cast<double>(rendered.counters.rays);
    of_raw.add(image, static_cast<double>(samples), raw_s, rays);
    const double filter_start = process_cpu_seconds();
    const auto render = [&](const RenderSettings& settings,
                            std::uint64_t count) -> absl::StatusOr<Image> {
      ASSIGN_OR_RETURN(const RenderedImage layer,
                       render_image(scene_, settings, count, pool_, stop_, /*progress=*/{},
                                    /*spill_folder=*/""));
      rays += static_cast<double>(layer.counters.rays);
      return layer.film.snapshot().image;
    };
    ASSIGN_OR_RETURN(const Denoised clean,
                     make_clean({image, rendered.film.first_part(), spec, samples},
                                one_by_one(render), Denoiser::kRegression, scene_.kernel(), pool_));
    of_clean.add(clean.image, static_cast<double>(samples),
                 raw_s + process_cpu_seconds() - filter_start, rays);
    ASSIGN_OR_RETURN(const Comparison of_image, compare_images(image, reference_));
    ASSIGN_OR_RETURN(const Comparison of_result, compare_images(clean.image, reference_));
    point.raw_flip += mean(of_image.flip);
    point.clean_flip += mean(of_result.flip);
    // The true mean square error, without the part that the noise of the reference causes.
    const double squares = of_result.errors.rmse * of_result.errors.rmse -
                           reference_error_.rmse * reference_error_.rmse;
    if (squares > 0) {
      point.error_ratios.push_back(clean.total.rmse_clean / std::sqrt(squares));
    }
    return absl::OkStatus();
  }

  /// Renders one image and adds it to the results.
  absl::Status add_image(Method method, const Scene& scene, std::uint64_t samples,
                         std::uint64_t seed, Seeds& seeds) {
    RenderSettings settings = settings_;
    settings.seed = seed;
    settings.integrator = integrator_of(method, settings.integrator);
    scene.guiding().clear();  // the CPU time of each image includes its own training
    const double start = process_cpu_seconds();
    const auto n = static_cast<double>(samples);
    if (method == Method::kIndependent) {
      IndependentSamples independent(scene, settings, pool_, stop_);
      for (std::uint64_t i = 0; i < samples; ++i) {
        RETURN_IF_ERROR(independent.next().status());
      }
      seeds.add(independent.mean(), n, process_cpu_seconds() - start, independent.rays());
      return absl::OkStatus();
    }
    if (method == Method::kAdaptive) {
      ASSIGN_OR_RETURN(const AdaptiveImage adaptive,
                       render_adaptively(scene, settings, samples, pool_, stop_));
      seeds.add(adaptive.image, adaptive.samples, process_cpu_seconds() - start, adaptive.rays);
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(const RenderedImage rendered,
                     render_image(scene, settings, samples, pool_, stop_, /*progress=*/{},
                                  /*spill_folder=*/""));
    seeds.add(rendered.film.snapshot().image, n, process_cpu_seconds() - start,
              static_cast<double>(rendered.counters.rays));
    guides_ = guides_ || rendered.counters.techniques != 0;
    return absl::OkStatus();
  }

  /// Measures kPixelStops: one point for each tolerance, instead of one for each number of samples.
  absl::StatusOr<StudyLine> pixel_stops() {
    std::vector<Seeds> seeds(std::size(kTolerances), Seeds(reference_, mean_));
    for (std::uint64_t seed = 0; seed < plan_.seeds; ++seed) {
      RenderSettings settings = settings_;
      settings.seed = settings_.seed + seed;
      settings.integrator = integrator_of(Method::kPixelStops, settings.integrator);
      const double start = process_cpu_seconds();
      ASSIGN_OR_RETURN(const StoppedImages stopped,
                       stop_by_pixels(scene_, settings, plan_.samples, pool_, stop_));
      // All tolerances are evaluated on one set of samples. So the cost of each is the whole cost
      // times the share of the samples that it used.
      const double cpu_s = process_cpu_seconds() - start;
      const auto all = static_cast<double>(plan_.samples);
      for (std::size_t i = 0; i < seeds.size(); ++i) {
        const double share = stopped.samples[i] / all;
        seeds[i].add(stopped.images[i], stopped.samples[i], cpu_s * share, stopped.rays * share);
      }
    }
    StudyLine line{Method::kPixelStops, {}};
    for (const Seeds& of_tolerance : seeds) {
      line.points.push_back(of_tolerance.point());
    }
    return line;
  }

  const Scene& scene_;
  const RenderSettings& settings_;
  const StudyPlan& plan_;
  Pool& pool_;
  const std::atomic<bool>& stop_;
  Image reference_;
  double mean_ = 0;
  ErrorMetrics reference_error_;
  bool guides_ = false;
};

}  // namespace

const char* method_name(Method method) {
  switch (method) {
    case Method::kFull:
      return "all techniques";
    case Method::kNoGuiding:
      return "no guiding, maps, portals";
    case Method::kNoMis:
      return "light sampling without MIS";
    case Method::kNoLights:
      return "BSDF sampling only";
    case Method::kAdaptive:
      return "adaptive";
    case Method::kIndependent:
      return "independent numbers";
    case Method::kPixelStops:
      return "stopping per pixel";
    case Method::kEveryObject:
      return "no BVH";
    case Method::kClean:
      return "clean";
  }
  return "";
}

std::uint64_t objects_of(const SceneDescription& scene) {
  std::uint64_t count = 0;
  for (const Geometry* geometry : {&scene.geometry, &scene.media.boundaries}) {
    count += geometry->size();
    for (const Instance& instance : geometry->instances) {
      const Shapes* group = group_of(*geometry, instance);
      count += group != nullptr ? group->size()
                                : geometry->meshes[index_of(instance.mesh)].triangles.size();
    }
  }
  return count;
}

std::vector<std::uint64_t> study_samples(std::uint64_t most) {
  std::vector<std::uint64_t> out;
  for (std::uint64_t samples = 1; samples < most; samples *= 4) {
    out.push_back(samples);
  }
  out.push_back(most);
  return out;
}

absl::StatusOr<StudyOfScene> study_scene(const std::string& name, const Scene& scene,
                                         const Scene* every_object, const RenderSettings& settings,
                                         const StudyPlan& plan, Pool& pool,
                                         const std::atomic<bool>& stop,
                                         const std::function<void(const std::string&)>& doing) {
  Study study(scene, settings, plan, pool, stop);
  doing(absl::StrCat(name, " · reference, ", plan.reference, " samples"));
  StudyOfScene out{.scene = name, .reference_error = 0, .lines = {}, .clean = {}};
  ASSIGN_OR_RETURN(out.reference_error, study.make_reference());
  if (plan.denoise) {
    doing(absl::StrCat(name, " · as rendered and clean"));
    RETURN_IF_ERROR(study.with_clean(out));
    return out;
  }
  for (const Method method : kMethods) {
    if (method == Method::kNoGuiding && !study.guides()) {
      continue;
    }
    doing(absl::StrCat(name, " · ", method_name(method)));
    ASSIGN_OR_RETURN(StudyLine line, study.line(method, scene));
    out.lines.push_back(std::move(line));
  }
  if (every_object != nullptr) {
    doing(absl::StrCat(name, " · ", method_name(Method::kEveryObject)));
    ASSIGN_OR_RETURN(StudyLine line, study.line(Method::kEveryObject, *every_object));
    out.lines.push_back(std::move(line));
  }
  return out;
}

std::optional<double> slope_of(const StudyLine& line) {
  std::vector<std::pair<double, double>> points;
  for (const StudyPoint& point : line.points) {
    points.emplace_back(point.samples, point.relative_rmse);
  }
  return power_of(points);
}

std::optional<double> cpu_s_to_1_percent(const StudyLine& line) {
  constexpr double kOnePercent = 0.01;
  if (line.method == Method::kPixelStops || line.method == Method::kClean) {
    return std::nullopt;
  }
  ErrorCurve curve;
  for (const StudyPoint& point : line.points) {
    curve.push_back({.samples = static_cast<std::uint64_t>(point.samples),
                     .cpu_s = point.cpu_s,
                     .estimate = {.relative_rmse = point.relative_rmse}});
  }
  return cpu_s_until(curve, kOnePercent);
}

}  // namespace bandsaw::coordinator
