#pragma once

// Scatters a photon at a surface. The photon takes a way that a path takes in the opposite
// direction.

#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The scattering of a photon at a surface.
struct PhotonScattering {
  Vec3 out;            ///< unit; the direction in which the photon leaves
  Rgb factor;          ///< by which the power of the photon changes
  bool counts = true;  ///< counts towards `max_depth` (BsdfSample::counts)
};

/// Samples the direction in which a photon leaves a surface at `point`. The photon comes from `in`,
/// a unit vector that points away from the surface. `numbers`: four random numbers in [0, 1). The
/// power changes by the BSDF of a path that travels in the opposite direction, because neither
/// refraction nor shading normals are symmetric (Veach 1997, section 5.3). Returns std::nullopt if
/// the photon is absorbed. The factor can be zero or not finite.
std::optional<PhotonScattering> scatter_photon(const Scene& scene, const SurfacePoint& point,
                                               const Vec3& in, const Sample4& numbers);

}  // namespace bandsaw
