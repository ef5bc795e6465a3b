#pragma once

// Albedo of surfaces. The integrator `albedo`, the guides (auxiliary images for the denoiser) and
// path guiding use it.

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the albedo, which depends on the kind of material:
/// - diffuse surface: its reflectance,
/// - metal: its reflectance at normal incidence,
/// - plastic: the reflectance of the surface below the coat,
/// - sheet that scatters diffusely: the sum of its reflectance and transmittance,
/// - glTF or principled material: its base colour,
/// - dielectric: white,
/// - emissive surface: its radiance.
/// Each channel is clamped to [0, 1]. The material MUST NOT be a mixture.
Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point);

}  // namespace bandsaw
