#pragma once

// Albedo of surfaces, for the integrator `albedo`.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the reflectance of diffuse surfaces and metals, the base colour of glTF materials, white
/// for dielectrics, and the radiance of emissive surfaces, clamped to 1. Each channel is in [0, 1].
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
