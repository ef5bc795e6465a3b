#pragma once

// Albedo of surfaces, for the integrator `albedo`, the guides of the denoiser and path guiding.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the albedo, by the kind of material: of diffuse surfaces the reflectance; of metals the
/// reflectance at normal incidence; of plastic the reflectance of the surface below the coat; of
/// sheets the sum of reflectance and transmittance; of glTF and principled materials the base
/// colour; of dielectrics white; of emissive surfaces the radiance, clamped to 1. Each channel is
/// in [0, 1]. The material MUST NOT be a mixture.
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
