#pragma once

// Scattering of a photon at a surface, as the opposite of what a path does there.

#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

struct PhotonScattering {
  Vec3 out;    ///< unit; the direction in which the photon leaves
  Rgb factor;  ///< of its power
};

/// Samples the direction in which a photon leaves a surface at `point`. It comes from `in`, a unit
/// vector that points away from the surface. The power changes by the BSDF of the opposite way, in
/// which paths travel: neither refraction nor shading normals are symmetric (Veach 1997, section
/// 5.3). Returns std::nullopt if the photon is absorbed. The factor can be zero or not finite.
std::optional<PhotonScattering> scatter_photon(const Scene& scene, const SurfacePoint& point,
                                               const Vec3& in, const Sample4& numbers);

}  // namespace bandsaw
