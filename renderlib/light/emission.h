#pragma once

// What an emissive surface gives.

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

/// The share of an emission below a clear coat that leaves along `direction`, unit
/// (KHR_materials_clearcoat, "Emission"; the normal is that of the mesh, whatever maps bend).
inline double through_coat(const Principled& material, absl::Span<const Texture> textures,
                           const SurfacePoint& point, const Vec3& direction) {
  if (material.coat.factor == 0) {
    return 1;
  }
  const double coat = material.coat.factor * look_up(textures, material.coat.texture, point).r;
  const double rim = schlick_rim(std::abs(dot(point.shading_normal, direction)));
  return 1 - std::clamp(coat, 0.0, 1.0) * (kCoatF0 + (1 - kCoatF0) * rim);
}

/// The radiance that `point` sends along `direction`, away from it; black unless its material is
/// emissive. Where the surface is there at all (material/opacity.h).
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
