// Returns for each kind of material the colour that a denoiser or a user expects. The colour is not
// the exact share of reflected light.

#include "renderlib/material/albedo.h"

#include <algorithm>

#include "renderlib/material/conductor.h"
#include "renderlib/material/look_up.h"

namespace bandsaw {

Rgb albedo_at(const Material& material, absl::Span<const Texture> textures,
              const SurfacePoint& point) {
  const auto value = [&](TextureId id, const Rgb& factor = gray(1)) {
    const Rgb found = look_up(textures, id, point) * factor;
    return Rgb{std::min(found.r, 1.0f), std::min(found.g, 1.0f), std::min(found.b, 1.0f)};
  };
  if (const auto* diffuse = std::get_if<Diffuse>(&material.kind)) {
    return value(diffuse->reflectance, point.color);
  }
  if (const auto* metal = std::get_if<Metal>(&material.kind)) {
    return value(metal->reflectance, point.color);
  }
  if (const auto* emissive = std::get_if<Emissive>(&material.kind)) {
    return value(emissive->radiance);
  }
  if (const auto* plastic = std::get_if<Plastic>(&material.kind)) {
    return value(plastic->reflectance, point.color);
  }
  if (const auto* conductor = std::get_if<Conductor>(&material.kind)) {
    return value(conductor->specular, conductor_reflectance(conductor->index, 1) * point.color);
  }
  if (const auto* sheet = std::get_if<DiffuseTransmission>(&material.kind)) {
    const Rgb sum =
        value(sheet->reflectance, point.color) + value(sheet->transmittance, point.color);
    return {std::min(sum.r, 1.0f), std::min(sum.g, 1.0f), std::min(sum.b, 1.0f)};
  }
  if (const auto* principled = std::get_if<Principled>(&material.kind)) {
    return value(principled->base_color, point.color);
  }
  if (const auto* thin = std::get_if<ThinPrincipled>(&material.kind)) {
    return value(thin->base_color, point.color);
  }
  if (const auto* layered = std::get_if<MetallicRoughness>(&material.kind)) {
    const Tint& base = layered->base_color;
    return value(base.texture, base.factor * point.color);
  }
  return gray(1);
}

}  // namespace bandsaw
