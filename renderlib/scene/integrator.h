#pragma once

// An integrator determines which value a sample of a pixel has. Some integrators return the
// arriving light, others a property of the first surface (integrate/sample_value.h).

#include <optional>

#include "absl/strings/string_view.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// The values are used in protocols and files.
enum class Integrator {
  /// Path tracing (integrate/path.h). A pilot, a short trial before the first sample, measures
  /// whether path guiding and photon maps are worth their cost in the scene
  /// (integrate/guiding_gain.h). If they are, this integrator works as kPathGuided, otherwise as
  /// kPathPlain.
  kPath = 0,
  kDirect = 1,   ///< direct light and the ambient term; paths continue at mirrors and glass
  kNormals = 2,  ///< (n + 1) / 2 of the shading normal in world space; black for a miss
  kDepth = 3,    ///< distance to the surface along the ray, scene units; 0 for a miss
  kAlbedo = 4,   ///< albedo (material/albedo.h); black for a miss
  /// Share of cosine-weighted directions without a nearby surface; 1 for a miss.
  kAmbientOcclusion = 5,
  kPathLights = 6,      ///< kPathPlain, but with light sampling alone where a BSDF has a pdf
  kPathScattering = 7,  ///< kPathPlain with BSDF sampling alone
  /// Path tracing with path guiding (integrate/guiding_training.h). Caustics of small lamps
  /// (integrate/caustics.h) and indirect light (integrate/indirect_photons.h) come from photon
  /// maps.
  kPathGuided = 8,
  kPathPlain = 9,  ///< path tracing without guiding and photon maps
};
inline constexpr int kLastIntegrator = 9;

/// Returns true for the integrators that path_radiance (integrate/path.h) computes.
constexpr bool computes_radiance(Integrator integrator) {
  return integrator == Integrator::kPath || integrator == Integrator::kDirect ||
         integrator == Integrator::kPathLights || integrator == Integrator::kPathScattering ||
         integrator == Integrator::kPathGuided || integrator == Integrator::kPathPlain;
}

/// Returns "path", "direct", "normals", "depth", "albedo", "ambient_occlusion", "path_lights",
/// "path_scattering", "path_guided" or "path_plain"; for the guides of the denoiser
/// (guide_integrators.h) "guide_albedo" or "guide_shape".
absl::string_view integrator_name(Integrator integrator);
/// Returns the integrator with this name. Returns std::nullopt for the two guides of the denoiser,
/// because users cannot select them, and for names that are not known.
std::optional<Integrator> integrator_named(absl::string_view name);

/// Scene parameters of kDirect and kAmbientOcclusion.
struct LocalShading {
  Rgb ambient;  ///< for kDirect: radiance from all directions, unshadowed; >= 0
  /// For kAmbientOcclusion: maximum distance of occluders, scene units, > 0.
  double occlusion_distance = kInfinity;
};

}  // namespace bandsaw
