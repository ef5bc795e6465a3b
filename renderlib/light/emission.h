#pragma once

// What an emissive surface gives.

#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// What of a material gives light.
struct Emission {
  Tint radiance;
  bool one_sided = false;
};

/// Nothing of a material that gives none.
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

/// The radiance that `point` sends along `direction`, away from it; black unless its material is
/// emissive. Where the surface is there at all (material/opacity.h).
inline Rgb emitted(const Material& material, absl::Span<const Texture> textures,
                   const SurfacePoint& point, const Vec3& direction) {
  const std::optional<Emission> emission = emission_of(material);
  if (!emission || (emission->one_sided && dot(point.geometric_normal, direction) <= 0)) {
    return {};
  }
  return look_up(textures, emission->radiance.texture, point) * emission->radiance.factor;
}

}  // namespace bandsaw
