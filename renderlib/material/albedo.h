#pragma once

// The colour of a surface without light.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Reflectance of diffuse surfaces and metals, the base colour of glTF's, white for clear ones; of
/// emissive ones the radiance, cut off at 1. Each channel in [0, 1].
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
