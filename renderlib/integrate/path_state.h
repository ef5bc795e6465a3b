#pragma once

// A path on its way: what the steps through surfaces and through media hand to each other.

#include <algorithm>
#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/integrate/see_through.h"
#include "renderlib/light/lights.h"

namespace bandsaw {

/// Where the path scattered last and how it left; of a ray through a lens that lights were asked
/// through, the point in focus.
struct Departure {
  Receiver from;
  double pdf = 0;
  bool delta = true;  ///< what is met was not asked for: of the camera, too
  /// How many times denser this place was chosen for asking a light than for going on; 1 on
  /// surfaces, where it is the same place.
  double asked = 1;
};

struct PathState {
  /// What begins with this ray. (An aggregate would be zeroed as a whole first, glasses and all.)
  explicit PathState(const Ray& from) : ray(from) {}

  Ray ray;  ///< of unit direction
  Rgb radiance = {};
  Rgb throughput = gray(1);
  /// What refraction did to the throughput; roulette must not mistake it for loss.
  double compression = 1;
  Departure departure = {};
  bool truncated = false;  ///< PathCounts::truncated
  Nesting nesting = {};    ///< the glasses it is inside of
};

/// What all steps of one path share.
struct PathContext {
  const Scene& scene;
  const PixelSampler& sampler;
  std::uint64_t sample = 0;
  const PathOptions& options;
  std::uint64_t& rays;
  std::uint32_t branches = 1;  ///< that the path has before it: PathOptions::branches, then 1

  /// Of one of the directions that the path goes on in.
  PathContext branch(std::uint32_t which) const {
    return {scene, sampler, sample * branches + which, options, rays};
  }
  Sample4 numbers(std::uint32_t group) const { return sampler.group(sample, group); }
  bool asks_lights() const {
    return scene.needs().lights && options.technique != Technique::kScatteringOnly;
  }
};

/// Russian roulette leaves paths alone whose throughput is at least this: README.md, "Why".
inline constexpr double kRouletteThroughput = 0.25;

/// Russian roulette after scattering `depth`; false: the path ends.
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
