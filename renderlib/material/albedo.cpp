#include "renderlib/material/albedo.h"

#include <algorithm>

#include "renderlib/material/look_up.h"

namespace bandsaw {

Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point) {
  const auto value = [&](TextureId id, const Rgb& factor = gray(1)) {
    const Rgb found = look_up(textures, id, point) * factor;
    return Rgb{std::min(found.r, 1.0f), std::min(found.g, 1.0f), std::min(found.b, 1.0f)};
  };
  if (const auto* diffuse = std::get_if<Diffuse>(&material)) {
    return value(diffuse->reflectance, point.color);
  }
  if (const auto* metal = std::get_if<Metal>(&material)) {
    return value(metal->reflectance, point.color);
  }
  if (const auto* emissive = std::get_if<Emissive>(&material)) {
    return value(emissive->radiance);
  }
  if (const auto* principled = std::get_if<Principled>(&material)) {
    const Tint& base = principled->base_color;
    return value(base.texture, base.factor * point.color);
  }
  return gray(1);
}

}  // namespace bandsaw
