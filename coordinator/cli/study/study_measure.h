#pragma once

// Speed against error: renders a scene with and without each technique that can be switched off, at
// rising numbers of samples and with several seeds, and compares each image with a converged one of
// another seed.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// How the image is made. All but kPixelStops have the same mean.
enum class Method {
  kFull,         ///< as render does it
  kNoMis,        ///< lights are found by asking them alone, where there is a density
  kNoLights,     ///< … by following directions alone: no next-event estimation
  kAdaptive,     ///< more samples where there is more noise, about as many in all
  kIndependent,  ///< random numbers that know nothing of each other in place of Owen-scrambled nets
  /// Independent numbers, and each pixel ends at the first multiple of 16 samples where 1.96
  /// standard errors of its mean are within a tolerance of it. What many ray tracers do; it is
  /// biased, since the samples decide themselves how many they are, and it is here to show by how
  /// much.
  kPixelStops,
  /// As kFull, to the bit; each ray is tested against every object of the scene. Where asked for.
  kEveryObject,
};
inline constexpr Method kMethods[] = {Method::kFull,     Method::kNoMis,       Method::kNoLights,
                                      Method::kAdaptive, Method::kIndependent, Method::kPixelStops};
const char* method_name(Method method);

/// Means over the seeds.
struct StudyPoint {
  double samples = 0;        ///< a pixel
  double relative_rmse = 0;  ///< root of the mean square
  double relative_mse = 0;
  double bias = 0;        ///< (mean of the image - mean of the reference) / mean of the reference
  double bias_error = 0;  ///< one standard error of that, over the seeds; 0: one seed
  double cpu_s = 0;       ///< summed over threads
  double rays = 0;
};

struct StudyLine {
  Method method = Method::kFull;
  std::vector<StudyPoint> points;  ///< by rising samples
};

struct StudyOfScene {
  std::string scene;
  double reference_error = 0;  ///< estimated relative RMSE of the reference
  std::vector<StudyLine> lines;
};

struct StudyPlan {
  std::uint64_t samples = 64;  ///< the most: 1, 4, 16, … up to these
  std::uint64_t seeds = 4;
  std::uint64_t reference = 1024;  ///< samples of the reference
};

/// Each ray is tested against at most so many objects, or a study takes too long.
inline constexpr std::uint64_t kMostObjects = 2'000;

/// Spheres, quads, triangles and disks as often as they are placed, boundaries of media too: what a
/// ray meets without a tree.
std::uint64_t objects_of(const SceneDescription& scene);

/// 1, 4, 16, …: powers of four up to `most`, which is the last.
std::vector<std::uint64_t> study_samples(std::uint64_t most);

/// Errors: as render_image; CANCELLED. `settings.seed` is the first of the seeds. `doing` hears
/// what comes next. `every_object`: the same scene, built to test everything (Tested); may be null.
absl::StatusOr<StudyOfScene> study_scene(const std::string& name, const Scene& scene,
                                         const Scene* every_object, const RenderSettings& settings,
                                         const StudyPlan& plan, Pool& pool,
                                         const std::atomic<bool>& stop,
                                         const std::function<void(const std::string&)>& doing);

/// p of "error ~ samples^p" over the line's points; nothing with less than two.
std::optional<double> slope_of(const StudyLine& line);

/// CPU seconds until the error is 1 %, as a report foresees it (core/error_curve.h). Nothing of
/// pixels that stop themselves: their error is no matter of samples alone.
std::optional<double> cpu_s_to_1_percent(const StudyLine& line);

}  // namespace bandsaw::coordinator
