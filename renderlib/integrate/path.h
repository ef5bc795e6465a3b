#pragma once

// Unidirectional path tracing with next-event estimation and multiple importance sampling. At each
// surface that has a pdf over directions, one light is sampled, and one direction is sampled from
// the BSDF. Both estimates are weighted by the power heuristic (Veach 1997, "Robust Monte Carlo
// Methods for Light Transport Simulation", sections 9.2 and 10.2).

#include <cstdint>
#include <optional>

#include "renderlib/camera/lens_view.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/math/rgb.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

class PhotonMaps;    // renderlib/integrate/caustics.h
class GuidingField;  // renderlib/guiding/guiding_field.h
class Portals;       // renderlib/guiding/portals.h

/// Strategies used to find light. All have the same expected value; the second and third exist only
/// so that tests can compare them with the first.
enum class Technique {
  kBoth,            ///< light sampling and BSDF sampling, with MIS weights
  kLightsOnly,      ///< light sampling alone, where the BSDF has a pdf
  kScatteringOnly,  ///< BSDF sampling alone
};

struct PathOptions {
  /// Maximum number of scatterings of a path, at surfaces and in media.
  std::uint32_t max_depth = 32;
  Technique technique = Technique::kBoth;
  bool russian_roulette = true;
  /// Local shading (the integrator `direct`): the path ends at the first surface that has a pdf,
  /// which reflects the lights and the scene's ambient term but no indirect light. Paths continue
  /// only at mirrors, glass and fuzzy metal.
  bool local = false;
  /// Number of directions in which a path continues from the first surface that has a pdf, each
  /// with an equal share (splitting: Arvo and Kirk 1990, "Particle Transport and Image Synthesis").
  /// A power of two. Direction i of sample n uses the random numbers of sample n * branches + i.
  std::uint32_t branches = 1;
  /// If not null, directions at surfaces are sampled from this field as well as from the BSDF
  /// (integrate/guided_bsdf.h), which changes no expected value. MUST outlive the paths.
  const GuidingField* guiding = nullptr;
  /// If not null, two kinds of light come from these photon maps where they are not empty: caustics
  /// (integrate/caustics.h), and indirect light beyond the first surface that scatters light over
  /// wide angles (integrate/indirect_photons.h). Then `branches` MUST be 1. MUST outlive the paths.
  const PhotonMaps* maps = nullptr;
  /// If not null, the background is also sampled through these portals at surfaces, which changes
  /// no expected value. MUST outlive the paths.
  const Portals* portals = nullptr;
};

/// Returns the value of `PathOptions::branches` that is most efficient for the scene (README.md,
/// "Splitting").
std::uint32_t branches_for(const Scene& scene);

/// Counters of path tracing; functions add to them.
struct PathCounts {
  std::uint64_t rays = 0;
  /// Number of paths that `max_depth` cut off before another scattering: the light that they would
  /// have carried is missing.
  std::uint64_t truncated = 0;
};

/// A camera ray for one sample of a pixel.
struct CameraRay {
  /// The constructor is implicit, so that a plain ray can be passed where no lens is involved.
  CameraRay(const Ray& of_camera) : ray(of_camera) {}

  Ray ray;  ///< unit direction
  /// The view of the lens through which the ray passes; set if lights beyond the plane of focus are
  /// to be sampled through the lens as well (through_lens.h).
  std::optional<LensView> lens = std::nullopt;
};

/// Returns the radiance arriving along `camera_ray` for sample number `sample` of the pixel. Adds
/// to `counts`. Deterministic; allocates nothing.
Rgb path_radiance(const Scene& scene, const CameraRay& camera_ray, const PixelSampler& sampler,
                  std::uint64_t sample, const PathOptions& options, PathCounts& counts);

}  // namespace bandsaw
