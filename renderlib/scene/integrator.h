#pragma once

// Integrators: the arriving light, or simpler properties of the first surface.

#include <optional>

#include "absl/strings/string_view.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// The values are used in protocols and files.
enum class Integrator {
  kPath = 0,     ///< path tracing (integrate/path.h)
  kDirect = 1,   ///< direct light and the ambient term; paths continue at mirrors and glass
  kNormals = 2,  ///< (n + 1) / 2 of the shading normal in world space; black for a miss
  kDepth = 3,    ///< distance to the surface along the ray, scene units; 0 for a miss
  kAlbedo = 4,   ///< albedo (material/albedo.h); black for a miss
  /// Share of cosine-weighted directions without a nearby surface; 1 for a miss.
  kAmbientOcclusion = 5,
  kPathLights = 6,      ///< kPath with light sampling alone, where a BSDF has a pdf
  kPathScattering = 7,  ///< kPath with BSDF sampling alone
  /// kPath with path guiding (integrate/guiding_training.h), and caustics from photon maps where
  /// they pay (integrate/caustics.h).
  kPathGuided = 8,
};
inline constexpr int kLastIntegrator = 8;

/// Returns true for those that path_radiance (integrate/path.h) computes.
constexpr bool computes_radiance(Integrator integrator) {
  return integrator == Integrator::kPath || integrator == Integrator::kDirect ||
         integrator == Integrator::kPathLights || integrator == Integrator::kPathScattering ||
         integrator == Integrator::kPathGuided;
}

/// Returns "path", "direct", "normals", "depth", "albedo", "ambient_occlusion", "path_lights",
/// "path_scattering" or "path_guided".
absl::string_view integrator_name(Integrator integrator);
std::optional<Integrator> integrator_named(absl::string_view name);

/// Scene parameters of kDirect and kAmbientOcclusion.
struct LocalShading {
  Rgb ambient;  ///< for kDirect: radiance from all directions, unshadowed; >= 0
  /// For kAmbientOcclusion: maximum distance of occluders, scene units, > 0.
  double occlusion_distance = kInfinity;
};

}  // namespace bandsaw
