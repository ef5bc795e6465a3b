#pragma once

// Radiance emitted by surfaces: at a point, for path tracing and light sampling, and its mean over
// a material, for the selection of lights.

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/material/mixture.h"
#include "renderlib/material/opacity.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the emission of a material; std::nullopt if it emits nothing or is a mixture.
inline std::optional<Emission> emission_of(const Material& material) {
  if (const auto* emissive = std::get_if<Emissive>(&material.kind); emissive != nullptr) {
    return Emission{{emissive->radiance, {1, 1, 1}}, emissive->one_sided};
  }
  return is_black(material.emission.radiance.factor) ? std::nullopt
                                                     : std::optional(material.emission);
}

/// The emission of a material as a whole. The material may be a mixture.
struct MeanEmission {
  Rgb radiance;            ///< a mean over the surface; an estimate for most textures
  bool one_sided = false;  ///< no part emits to the side opposite to the geometric normal
};

/// Returns true if material `id` or a part of it emits.
inline bool emits(absl::Span<const Material> materials, MaterialId id) {
  const auto* mix = std::get_if<Mix>(&materials[index_of(id)].kind);
  return mix == nullptr ? emission_of(materials[index_of(id)]).has_value()
                        : emits(materials, mix->a) || emits(materials, mix->b);
}

/// Returns the mean emission of material `id`; `mean_of` returns the mean of a texture.
template <class MeanOf>
MeanEmission mean_emission(absl::Span<const Material> materials, MaterialId id,
                           const MeanOf& mean_of) {
  if (const auto* mix = std::get_if<Mix>(&materials[index_of(id)].kind)) {
    const MeanEmission a = mean_emission(materials, mix->a, mean_of);
    const MeanEmission b = mean_emission(materials, mix->b, mean_of);
    // The mean of the amount may be an estimate, so both parts get a weight above 0.
    const float amount = std::clamp(luminance(mean_of(mix->amount)), 0.01f, 0.99f);
    return {lerp(a.radiance, b.radiance, amount),
            (a.one_sided || is_black(a.radiance)) && (b.one_sided || is_black(b.radiance))};
  }
  const std::optional<Emission> emission = emission_of(materials[index_of(id)]);
  return emission ? MeanEmission{mean_of(emission->radiance.texture) * emission->radiance.factor,
                                 emission->one_sided}
                  : MeanEmission{};
}

/// Returns the share of the emission, in [0, 1], that leaves through a clear coat along the unit
/// vector `direction` (KHR_materials_clearcoat, "Emission"). The coat's normal is the interpolated
/// shading normal, without normal maps.
inline double through_coat(const MetallicRoughness& material, absl::Span<const Texture> textures,
                           const SurfacePoint& point, const Vec3& direction) {
  if (material.coat.factor == 0) {
    return 1;
  }
  const double coat = material.coat.factor * look_up(textures, material.coat.texture, point).r;
  const double rim = schlick_rim(std::abs(dot(point.shading_normal, direction)));
  return 1 - std::clamp(coat, 0.0, 1.0) * (kCoatF0 + (1 - kCoatF0) * rim);
}

/// Returns the radiance emitted from `point` along the unit vector `direction`, which points away
/// from it; black if the material does not emit. Opacity (material/opacity.h) is not included. The
/// material MUST NOT be a mixture.
inline Rgb emitted(const Material& material, absl::Span<const Texture> textures,
                   const SurfacePoint& point, const Vec3& direction) {
  const std::optional<Emission> emission = emission_of(material);
  if (!emission || (emission->one_sided && dot(point.geometric_normal, direction) <= 0)) {
    return {};
  }
  const Rgb radiance =
      look_up(textures, emission->radiance.texture, point) * emission->radiance.factor;
  const auto* coated = std::get_if<MetallicRoughness>(&material.kind);
  return coated == nullptr
             ? radiance
             : radiance * static_cast<float>(through_coat(*coated, textures, point, direction));
}

/// Returns the radiance emitted by material `id`, for light sampling. If the material is a mixture
/// or partly transparent, a random choice of each sample decides which part is there, or whether
/// the surface is there. The result is the expected value over these choices. A hidden lamp (an
/// emitter that the camera does not see, material/opacity.h) emits as if its opacity were 1, but
/// emits nothing if `to_camera` is true.
inline Rgb emitted_if_present(absl::Span<const Material> materials, MaterialId id,
                              absl::Span<const Texture> textures, const SurfacePoint& point,
                              const Vec3& direction, bool to_camera) {
  const Material& material = materials[index_of(id)];
  if (const auto* mix = std::get_if<Mix>(&material.kind)) {
    return lerp(emitted_if_present(materials, mix->a, textures, point, direction, to_camera),
                emitted_if_present(materials, mix->b, textures, point, direction, to_camera),
                static_cast<float>(amount_at(*mix, textures, point)));
  }
  const double shown =
      is_hidden_lamp(material) ? (to_camera ? 0 : 1) : opacity(material, textures, point);
  return emitted(material, textures, point, direction) * static_cast<float>(shown);
}

}  // namespace bandsaw
