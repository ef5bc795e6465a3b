#pragma once

// Radiance emitted by surfaces.

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The emission of a material.
struct Emission {
  Tint radiance;
  bool one_sided = false;
};

/// Returns std::nullopt if the material emits nothing.
inline std::optional<Emission> emission_of(const Material& material) {
  if (const auto* emissive = std::get_if<Emissive>(&material); emissive != nullptr) {
    return Emission{{emissive->radiance, {1, 1, 1}}, emissive->one_sided};
  }
  const auto* principled = std::get_if<Principled>(&material);
  if (principled == nullptr || is_black(principled->emissive.factor)) {
    return std::nullopt;
  }
  return Emission{principled->emissive, !principled->double_sided};
}

/// Returns the share of the emission that leaves through a clear coat along the unit vector
/// `direction` (KHR_materials_clearcoat, "Emission"). The normal is the mesh's shading normal,
/// without normal maps.
inline double through_coat(const Principled& material, absl::Span<const Texture> textures,
                           const SurfacePoint& point, const Vec3& direction) {
  if (material.coat.factor == 0) {
    return 1;
  }
  const double coat = material.coat.factor * look_up(textures, material.coat.texture, point).r;
  const double rim = schlick_rim(std::abs(dot(point.shading_normal, direction)));
  return 1 - std::clamp(coat, 0.0, 1.0) * (kCoatF0 + (1 - kCoatF0) * rim);
}

/// Returns the radiance emitted from `point` along `direction`, which points away from it; black
/// unless the material is emissive. Opacity (material/opacity.h) is not included.
inline Rgb emitted(const Material& material, absl::Span<const Texture> textures,
                   const SurfacePoint& point, const Vec3& direction) {
  const std::optional<Emission> emission = emission_of(material);
  if (!emission || (emission->one_sided && dot(point.geometric_normal, direction) <= 0)) {
    return {};
  }
  const Rgb radiance =
      look_up(textures, emission->radiance.texture, point) * emission->radiance.factor;
  const auto* principled = std::get_if<Principled>(&material);
  return principled == nullptr
             ? radiance
             : radiance * static_cast<float>(through_coat(*principled, textures, point, direction));
}

}  // namespace bandsaw
