#pragma once

// The radiance along a camera ray by path tracing: at every surface with a density of directions
// one light is asked for light and one direction is followed; what both could find is weighed by
// the power heuristic (Veach 1997, "Robust Monte Carlo Methods for Light Transport Simulation",
// sections 9.2 and 10.2).

#include <cstdint>
#include <optional>

#include "renderlib/camera/lens_view.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/math/rgb.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// How light is looked for. All have the same mean; all but the first exist to be compared with it.
enum class Technique {
  kBoth,            ///< both, weighed
  kLightsOnly,      ///< asking lights alone, where there is a density
  kScatteringOnly,  ///< following directions alone
};

struct PathOptions {
  std::uint32_t max_depth = 32;  ///< most times a path scatters, at surfaces and in media
  Technique technique = Technique::kBoth;
  bool russian_roulette = true;
  /// Local shading: what surfaces with a density scatter of the lights and of the scene's ambient
  /// term, nothing of each other; only mirrors, glass and fuzzy metal are followed.
  bool local = false;
  /// A power of two: in how many directions a path goes on from the first surface with a density,
  /// each for its share (splitting: Arvo, Kirk 1990, "Particle Transport and Image Synthesis").
  /// Direction i of sample n takes the numbers of sample n * branches + i.
  std::uint32_t branches = 1;
};

/// How many `branches` serve the scene: README.md, "Why".
std::uint32_t branches_for(const Scene& scene);

/// What following paths comes to.
struct PathCounts {
  std::uint64_t rays = 0;
  /// Paths that would have been scattered once more than `max_depth` allows: what they would have
  /// brought is missing.
  std::uint64_t truncated = 0;
};

/// Scattering from this one on may end by Russian roulette.
inline constexpr std::uint32_t kRouletteDepth = 3;

/// What a sample of a pixel looks along.
struct CameraRay {
  /// Not explicit: any ray is one.
  CameraRay(const Ray& of_camera) : ray(of_camera) {}

  Ray ray;  ///< of unit direction
  /// The lens it came through, where lamps beyond its focus are to be asked as well.
  std::optional<LensView> lens = std::nullopt;
};

/// The radiance that comes back along `camera_ray` by sample number `sample` of the pixel. Adds to
/// `counts`. Deterministic, allocates nothing.
Rgb path_radiance(const Scene& scene, const CameraRay& camera_ray, const PixelSampler& sampler,
                  std::uint64_t sample, const PathOptions& options, PathCounts& counts);

}  // namespace bandsaw
