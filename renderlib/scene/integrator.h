#pragma once

// What an image shows: the light that arrives, or something simpler about the first surface.

#include <optional>

#include "absl/strings/string_view.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// The numbers are those of the protocols and files.
enum class Integrator {
  kPath = 0,              ///< path tracing (integrate/path.h)
  kDirect = 1,            ///< light of lamps and the ambient term; mirrors and glass are followed
  kNormals = 2,           ///< (n + 1) / 2 of the shading normal, in world space; a miss is black
  kDepth = 3,             ///< distance to the surface along the ray, scene units; a miss is 0
  kAlbedo = 4,            ///< colour without light (material/albedo.h); a miss is black
  kAmbientOcclusion = 5,  ///< share of cosine-weighted directions without a surface near; a miss: 1
  kPathLights = 6,        ///< kPath that only asks lights, where a surface has a density
  kPathScattering = 7,    ///< kPath that asks no light and waits until it meets one
};
inline constexpr int kLastIntegrator = 7;

/// Those that path_radiance (integrate/path.h) computes.
constexpr bool follows_light(Integrator integrator) {
  return integrator == Integrator::kPath || integrator == Integrator::kDirect ||
         integrator == Integrator::kPathLights || integrator == Integrator::kPathScattering;
}

/// "path", "direct", "normals", "depth", "albedo", "ambient_occlusion", "path_lights",
/// "path_scattering".
absl::string_view integrator_name(Integrator integrator);
std::optional<Integrator> integrator_named(absl::string_view name);

/// What the simpler integrators want to know of a scene.
struct LocalShading {
  Rgb ambient;  ///< radiance from everywhere, unshadowed; of kDirect; >= 0
  double occlusion_distance = kInfinity;  ///< what is farther occludes nothing, scene units, > 0
};

}  // namespace bandsaw
