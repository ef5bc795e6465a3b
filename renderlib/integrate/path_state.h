#pragma once

// State of a path under construction, shared by the steps at surfaces and in media.

#include <cstdint>

#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/mis.h"
#include "renderlib/integrate/path.h"

namespace bandsaw {

/// Maximum value of PathState::uncounted: with it, a path of 1024 scatterings that count stays
/// below the 2^11 scatterings for which there are random numbers (sampling/sampler.h).
inline constexpr std::uint32_t kMaxUncounted = 1000;

inline constexpr std::uint32_t kNoChain = 0xffffffffu;

struct PathState {
  /// Starts a path with this ray. (As an aggregate, all of it would be zeroed first, including the
  /// large `NestedDielectrics`.)
  explicit PathState(const Ray& from) : ray(from) {}

  Ray ray;  ///< unit direction
  Rgb radiance = {};
  Rgb throughput = gray(1);
  /// Product of the factors by which refraction and guiding scaled the throughput. Russian roulette
  /// divides it out, because it is no loss of energy.
  double compression = 1;
  PreviousVertex previous = {};
  /// Number of scatterings that do not count towards `max_depth` (BsdfSample::counts).
  std::uint32_t uncounted = 0;
  /// Number of casters since the last receiver (integrate/caustics.h); kNoChain where there was
  /// another scattering in between, or no receiver.
  std::uint32_t chain = kNoChain;
  bool after_receiver = false;     ///< a receiver of caustics has scattered the path
  bool truncated = false;          ///< see PathCounts::truncated
  NestedDielectrics nesting = {};  ///< glasses that contain the path
};

/// Constants of one path.
struct PathContext {
  const Scene& scene;
  const PixelSampler& sampler;
  std::uint64_t sample = 0;
  const PathOptions& options;
  std::uint64_t& rays;
  /// Number of directions into which the path splits at the next surface with a pdf:
  /// PathOptions::branches until it has been split, then 1.
  std::uint32_t branches = 1;

  /// Returns the context of one of the directions of a split.
  PathContext branch(std::uint32_t which) const {
    return {scene, sampler, sample * branches + which, options, rays};
  }
  Sample4 numbers(std::uint32_t group) const { return sampler.group(sample, group); }
  /// Returns the numbers with which media that vary in space are tracked; without such media,
  /// numbers that are never used.
  NumberStream stream(std::uint32_t group) const {
    return scene.features().grids ? sampler.stream(sample, group) : NumberStream(0);
  }
  /// Returns true if the path may not be scattered as number `depth`.
  bool is_at_end(const PathState& path, std::uint32_t depth) const {
    return depth - path.uncounted >= options.max_depth;
  }
  /// Returns the number of scatterings that may follow scattering `depth`.
  std::uint32_t scatterings_left(const PathState& path, std::uint32_t depth) const {
    return options.max_depth - 1 - (depth - path.uncounted);
  }
  bool samples_lights() const {
    return scene.features().lights && options.technique != Technique::kScatteringOnly;
  }
};

}  // namespace bandsaw
