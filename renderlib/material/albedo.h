#pragma once

// Albedo of surfaces, for the integrator `albedo`, the guides of the denoiser and path guiding.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the albedo, which depends on the kind of material. It is the reflectance of a diffuse
/// surface, the reflectance of a metal at normal incidence, the reflectance of the surface below
/// the coat of plastic, the sum of reflectance and transmittance of a sheet, the base colour of a
/// glTF or principled material, white for a dielectric, and the radiance of an emissive surface,
/// clamped to 1. Each channel is in [0, 1]. The material MUST NOT be a mixture.
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
