#pragma once

// State of a path under construction, shared by the steps at surfaces and in media.

#include <algorithm>
#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/integrate/see_through.h"
#include "renderlib/light/lights.h"

namespace bandsaw {

/// The previous vertex of the path and the pdf with which the path left it: the inputs of the MIS
/// weight at the next hit. For a camera ray whose lens was used for light sampling, the vertex is
/// the point in focus.
struct Departure {
  Receiver from;
  double pdf = 0;
  /// True if light sampling could not have produced the next hit (camera rays, specular
  /// directions): its MIS weight is 1.
  bool delta = true;
  /// Ratio of the distance pdf used for light sampling to the free-flight pdf at this vertex; 1 on
  /// surfaces, where both strategies use the same point.
  double asked = 1;
};

struct PathState {
  /// Starts a path with this ray. (As an aggregate, all of it would be zeroed first, including the
  /// large `Nesting`.)
  explicit PathState(const Ray& from) : ray(from) {}

  Ray ray;  ///< unit direction
  Rgb radiance = {};
  Rgb throughput = gray(1);
  /// Product of the factors by which refraction scaled the throughput. Russian roulette divides it
  /// out, because it is no loss of energy.
  double compression = 1;
  Departure departure = {};
  bool truncated = false;  ///< see PathCounts::truncated
  Nesting nesting = {};    ///< glasses that contain the path
};

/// Constants of one path.
struct PathContext {
  const Scene& scene;
  const PixelSampler& sampler;
  std::uint64_t sample = 0;
  const PathOptions& options;
  std::uint64_t& rays;
  /// Directions to split into at the next surface with a pdf: PathOptions::branches, then 1.
  std::uint32_t branches = 1;

  /// Returns the context of one of the directions of a split.
  PathContext branch(std::uint32_t which) const {
    return {scene, sampler, sample * branches + which, options, rays};
  }
  Sample4 numbers(std::uint32_t group) const { return sampler.group(sample, group); }
  bool asks_lights() const {
    return scene.features().lights && options.technique != Technique::kScatteringOnly;
  }
};

/// Paths whose throughput is at least this always survive Russian roulette (README.md, "Russian
/// roulette").
inline constexpr double kRouletteThroughput = 0.25;

/// Applies Russian roulette after scattering `depth`, with the random number `number` in [0, 1).
/// Returns false if the path ends.
inline bool survives(const PathContext& context, std::uint32_t depth, double number,
                     PathState& path) {
  if (context.options.russian_roulette && depth + 1 >= kRouletteDepth) {
    const double survival = std::clamp(
        max_component(path.throughput) / (path.compression * kRouletteThroughput), 0.05, 1.0);
    if (number >= survival) {
      return false;
    }
    path.throughput = path.throughput * static_cast<float>(1 / survival);
  }
  return !is_black(path.throughput);
}

}  // namespace bandsaw
