#pragma once

// Measures error against cost: renders a scene with and without each technique that can be
// disabled, with increasing numbers of samples and several seeds, and compares each image with a
// converged reference that has another seed.

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

/// Technique with which the image is made. All except kPixelStops have the same expected value.
enum class Method {
  kFull,       ///< as in `bandsaw render`
  kNoGuiding,  ///< neither path guiding nor photon maps; only where kFull uses one of them
  kNoMis,      ///< light sampling only, without MIS, for lights that have a pdf
  kNoLights,   ///< BSDF sampling only: no next-event estimation
  kAdaptive,   ///< samples distributed by noise, with about the same total
  /// Independent random numbers instead of Owen-scrambled nets; neither guiding nor maps.
  kIndependent,
  /// As kIndependent; each pixel stops at the first multiple of 8 samples at which 1.96
  /// standard errors of its mean are within a tolerance of it, as in many ray tracers. The result
  /// is biased, because the samples determine their own number; the method is included to show the
  /// amount of bias.
  kPixelStops,
  /// Same bits as kFull; each ray is tested against every object of the scene. Only if requested.
  kEveryObject,
  /// kFull with its noise removed (renderlib/denoise). Biased. Only if requested.
  kClean,
};
inline constexpr Method kMethods[] = {Method::kFull,      Method::kNoGuiding, Method::kNoMis,
                                      Method::kNoLights,  Method::kAdaptive,  Method::kIndependent,
                                      Method::kPixelStops};
const char* method_name(Method method);

/// Means over the seeds.
struct StudyPoint {
  double samples = 0;        ///< per pixel
  double relative_rmse = 0;  ///< root of the mean square over the seeds
  double relative_mse = 0;
  /// Relative bias: (mean of the image - mean of the reference) / mean of the reference.
  double bias = 0;
  double bias_error = 0;  ///< one standard error of bias over the seeds; 0: one seed
  double cpu_s = 0;       ///< summed over threads
  double rays = 0;
};

struct StudyLine {
  Method method = Method::kFull;
  std::vector<StudyPoint> points;  ///< sorted by samples
};

struct StudyOfScene {
  std::string scene;
  double reference_error = 0;  ///< estimated relative RMSE of the reference
  std::vector<StudyLine> lines;
  std::vector<CleanPoint> clean = {};  ///< results with StudyPlan::denoise
};

struct StudyPlan {
  std::uint64_t samples = 64;  ///< maximum: 1, 4, 16, … up to this
  std::uint64_t seeds = 4;
  std::uint64_t reference = 1024;  ///< samples per pixel of the reference
  /// Measure kFull and kClean, from 4 samples on, instead of kMethods.
  bool denoise = false;
};

/// Maximum number of objects for kEveryObject; with more, a study takes too long.
inline constexpr std::uint64_t kMaxObjects = 2'000;

/// Counts spheres, quads, triangles and disks once per placement, and boundaries of media: the
/// number of intersection tests of a ray without a BVH.
std::uint64_t objects_of(const SceneDescription& scene);

/// Returns 1, 4, 16, …: powers of four below `most`, then `most`.
std::vector<std::uint64_t> study_samples(std::uint64_t most);

/// Runs the study of one scene. `settings.seed` is the first of the seeds. `doing` is called with a
/// description of the next step. `every_object`: the same scene, built to test every object
/// (Traversal::kBruteForce); may be nullptr. Errors: as render_image; CANCELLED.
absl::StatusOr<StudyOfScene> study_scene(const std::string& name, const Scene& scene,
                                         const Scene* every_object, const RenderSettings& settings,
                                         const StudyPlan& plan, Pool& pool,
                                         const std::atomic<bool>& stop,
                                         const std::function<void(const std::string&)>& doing);

/// Returns p of "error ~ samples^p" over the line's points; std::nullopt with fewer than two.
std::optional<double> slope_of(const StudyLine& line);

/// Returns the CPU seconds until the error is 1 %, as predicted in a report
/// (scheduler/api/error_curve.h). Returns std::nullopt for kPixelStops and kClean, whose errors do
/// not depend on the number of samples alone.
std::optional<double> cpu_s_to_1_percent(const StudyLine& line);

}  // namespace bandsaw::coordinator
