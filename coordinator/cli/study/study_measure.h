#pragma once

// Measures error against cost for `bandsaw study`: renders a scene with and without each technique
// that can be disabled, with increasing numbers of samples and several seeds. Each image is
// compared with a converged reference image of another seed.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/study/study_clean.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// How an image is rendered. All methods except kPixelStops and kClean have the same expected
/// value.
enum class Method {
  kFull,  ///< as in `bandsaw render`
  /// Without path guiding, photon maps and portals (openings through which the background lights a
  /// room). Measured only where kFull uses one of them.
  kNoGuiding,
  kNoMis,     ///< no MIS: BSDF sampling counts only the emission that light sampling cannot reach
  kNoLights,  ///< BSDF sampling only: no next-event estimation
  kAdaptive,  ///< more samples where there is more noise, with about the same total
  /// Independent random numbers instead of Owen-scrambled nets. Without path guiding, photon maps
  /// and portals.
  kIndependent,
  /// As kIndependent, except that each pixel stops when 1.96 standard errors of its mean are at
  /// most a given fraction of the mean. This is tested at multiples of 16 samples. Many ray tracers
  /// stop pixels by such a rule. The result is biased, because the samples determine their own
  /// number. The method is included to show the amount of bias.
  kPixelStops,
  /// As kFull, but without a BVH: each ray is tested against every object of the scene. The pixels
  /// have the same bits. Measured only if requested.
  kEveryObject,
  /// As kFull, then the noise is removed (renderlib/denoise). Biased. Measured only if requested.
  kClean,
};
/// The methods that are measured unless another choice is requested.
inline constexpr Method kMethods[] = {Method::kFull,      Method::kNoGuiding, Method::kNoMis,
                                      Method::kNoLights,  Method::kAdaptive,  Method::kIndependent,
                                      Method::kPixelStops};
/// Returns the name that is shown in tables.
const char* method_name(Method method);

/// Results for one number of samples, as means over the seeds.
struct StudyPoint {
  double samples = 0;        ///< per pixel
  double relative_rmse = 0;  ///< root mean square of the relative RMSE over the seeds
  double relative_mse = 0;   ///< relMSE (renderlib/compare/error_metrics.h)
  /// Relative bias: (mean of the image - mean of the reference) / mean of the reference.
  double bias = 0;
  double bias_error = 0;  ///< one standard error of bias over the seeds; 0: one seed
  double cpu_s = 0;       ///< CPU seconds of an image, summed over threads
  double rays = 0;        ///< number of rays of an image
};

/// The results of one method.
struct StudyLine {
  Method method = Method::kFull;
  std::vector<StudyPoint> points;  ///< sorted by samples
};

struct StudyOfScene {
  std::string scene;
  double reference_error = 0;  ///< estimated relative RMSE of the reference, unbiased
  std::vector<StudyLine> lines;
  std::vector<CleanPoint> clean = {};  ///< results with StudyPlan::denoise
};

struct StudyPlan {
  std::uint64_t samples = 64;      ///< maximum per pixel; study_samples() lists the smaller ones
  std::uint64_t seeds = 4;         ///< number of images to average over
  std::uint64_t reference = 1024;  ///< samples per pixel of the reference
  /// Measure kFull and kClean, from 4 samples on, instead of kMethods.
  bool denoise = false;
};

/// Maximum number of objects for kEveryObject; with more, a study takes too long.
inline constexpr std::uint64_t kMaxObjects = 2'000;

/// Returns the number of intersection tests of a ray without a BVH. It is the number of spheres,
/// quads, triangles and disks, each counted once per placement. The boundaries of media are
/// included.
std::uint64_t objects_of(const SceneDescription& scene);

/// Returns 1, 4, 16, …: powers of four below `most`, then `most`.
std::vector<std::uint64_t> study_samples(std::uint64_t most);

/// Runs the study of one scene. `settings.seed` is the first of the seeds. `doing` is called with a
/// description of the next step. `every_object`: the same scene, built to test every object
/// (Traversal::kBruteForce); nullptr: kEveryObject is not measured. Errors: those of render_image;
/// CANCELLED: `stop` was set.
absl::StatusOr<StudyOfScene> study_scene(const std::string& name, const Scene& scene,
                                         const Scene* every_object, const RenderSettings& settings,
                                         const StudyPlan& plan, Pool& pool,
                                         const std::atomic<bool>& stop,
                                         const std::function<void(const std::string&)>& doing);

/// Fits "relative RMSE ~ samples^p" to the line's points with an error above 0, and returns p.
/// Returns std::nullopt if these points do not have two different numbers of samples.
std::optional<double> slope_of(const StudyLine& line);

/// Returns the CPU seconds until the relative RMSE is 1 %, computed as for reports (cpu_s_until in
/// scheduler/api/error_curve.h, which extrapolates). Returns std::nullopt if it cannot be computed.
/// Also returns std::nullopt for kPixelStops and kClean: they are biased, and their bias does not
/// fall with the samples as noise does.
std::optional<double> cpu_s_to_1_percent(const StudyLine& line);

}  // namespace bandsaw::coordinator
