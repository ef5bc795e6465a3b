#pragma once

// Albedo of surfaces, for the integrator `albedo`, the guides of the denoiser and path guiding.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the reflectance of diffuse surfaces and metals (at normal incidence), that of the
/// surface below the coat of plastic, the sum of reflectance and transmittance of sheets, the base
/// colour of glTF and principled materials, white for dielectrics, and the radiance of emissive
/// surfaces, clamped to 1. Each channel is in [0, 1]. The material MUST NOT be a mixture.
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
