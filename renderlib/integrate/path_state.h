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

/// Value of PathState::chain of a path that is in no chain of casters.
inline constexpr std::uint32_t kNoChain = 0xffffffffu;

/// The state that changes along a path.
struct PathState {
  /// Starts a path with this ray. (If this struct were an aggregate, all of it would be zeroed
  /// first, including the large `NestedDielectrics`.)
  explicit PathState(const Ray& from) : ray(from) {}

  Ray ray;            ///< unit direction
  Rgb radiance = {};  ///< found so far, as seen by the camera
  Rgb throughput = gray(1);
  /// Product of the factors by which refraction and guiding scaled the throughput. Russian roulette
  /// divides it out, because this scaling is no loss of energy.
  double compression = 1;
  PreviousVertex previous = {};
  /// Number of scatterings that do not count towards `max_depth` (BsdfSample::counts), and of
  /// hidden lamps that the path has passed.
  std::uint32_t uncounted = 0;
  /// For photon maps (integrate/caustics.h): the number of casters (surfaces that cast caustics)
  /// since the last receiver (a surface that scatters light over wide angles). It is kNoChain if
  /// the path had another scattering since then, or if it has met no receiver yet.
  std::uint32_t chain = kNoChain;
  /// The share of the light at the end of this chain that photons do not estimate
  /// (share_of_paths()). Unspecified if `chain` is kNoChain.
  Rgb share_of_paths = {};
  bool after_receiver = false;  ///< a receiver of caustics has scattered the path
  /// True if the light of the next receiver was already taken from a photon map of indirect light,
  /// so that the path ends there.
  bool ends_at_receiver = false;
  double reach = 0;                ///< length of the path since the last receiver that scattered it
  bool truncated = false;          ///< `max_depth` forbade a further scattering
  NestedDielectrics nesting = {};  ///< glasses that contain the path
};

/// The data that stay the same along a path. The objects MUST outlive it.
struct PathContext {
  const Scene& scene;
  const PixelSampler& sampler;
  std::uint64_t sample = 0;
  const PathOptions& options;
  std::uint64_t& rays;  ///< rays that are traced are added here
  /// Number of directions into which the path splits at the next surface with a pdf:
  /// PathOptions::branches until it has been split, then 1.
  std::uint32_t branches = 1;

  /// Returns the context of direction number `which` of a split: it has a sample number of its own.
  PathContext branch(std::uint32_t which) const {
    return {scene, sampler, sample * branches + which, options, rays};
  }
  /// Returns the random numbers of a group (sampling/sampler.h lists the groups).
  Sample4 numbers(std::uint32_t group) const { return sampler.group(sample, group); }
  /// Returns the numbers with which media that vary in space are tracked; without such media,
  /// numbers that are never used.
  NumberStream stream(std::uint32_t group) const {
    return scene.features().grids ? sampler.stream(sample, group) : NumberStream(0);
  }
  /// Returns true if `max_depth` forbids scattering number `depth` (counted from 0).
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
