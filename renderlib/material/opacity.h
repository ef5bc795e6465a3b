#pragma once

// Opacity of a surface at a point. It is the surface's alpha, except that it is 0 for glass that
// does not refract and for hidden lamps (emitters that the camera does not see and that stop no
// light). Camera and bounce rays are stopped with this probability; shadow rays are attenuated by
// it.

#include <algorithm>
#include <cmath>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/material/mixture.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// A boundary does not refract if its relative index of refraction differs from 1 by less than this
/// number.
inline constexpr double kMinRefraction = 1e-6;

/// Returns true for glass with the same index as its surroundings and for panes that reflect
/// nothing: light goes straight through both. It is false for glass with a priority, which may have
/// an effect because it excludes other glass, and for surfaces that emit.
inline bool bends_nothing(const Material& material) {
  if (!is_black(material.emission.radiance.factor)) {
    return false;
  }
  if (const auto* pane = std::get_if<ThinDielectric>(&material.kind)) {
    return pane->transmission == Rgb{1, 1, 1} &&
           std::abs(pane->index_of_refraction - 1) < kMinRefraction;
  }
  const auto* glass = std::get_if<Dielectric>(&material.kind);
  return glass != nullptr && glass->priority == 0 && !glass->index_map &&
         std::abs(glass->index_of_refraction - 1) < kMinRefraction;
}

/// Returns true for an emitter that stops no light and is not visible from the camera.
inline bool is_hidden_lamp(const Material& material) {
  const auto* emissive = std::get_if<Emissive>(&material.kind);
  return emissive != nullptr && emissive->hidden;
}

/// Returns true if opacity() can be other than 1; false for a mixture, whatever its parts are.
inline bool has_alpha(const Material& material) {
  return material.alpha.mode != AlphaMode::kOpaque || bends_nothing(material) ||
         is_hidden_lamp(material);
}

/// Returns the probability that a ray is stopped here, in [0, 1]. The material MUST NOT be a
/// mixture.
inline double opacity(const Material& material, absl::Span<const Texture> textures,
                      const SurfacePoint& point) {
  if (!has_alpha(material)) {
    return 1;
  }
  if (bends_nothing(material) || is_hidden_lamp(material)) {
    return 0;
  }
  const Alpha& alpha = material.alpha;
  const Rgb texel = look_up(textures, alpha.value.texture, point);
  const auto value = [&](float part) { return std::clamp(alpha.value.factor * part, 0.0, 1.0); };
  if (alpha.mode == AlphaMode::kMask) {
    // Both sides are compared as floats, because texels are floats: a texel of 0.7 must reach a
    // cutoff of 0.7.
    const double part = value(alpha.luminance ? luminance_exact_for_grays(texel) : texel.r);
    return static_cast<float>(part) >= static_cast<float>(alpha.cutoff) ? 1 : 0;
  }
  return value(alpha.luminance ? luminance(texel) : texel.r);
}

/// Returns the opacity of material `id`. The opacity of a mixture is the mean over its parts,
/// weighted by the amount.
inline double opacity(absl::Span<const Material> materials, MaterialId id,
                      absl::Span<const Texture> textures, const SurfacePoint& point) {
  const Material& material = materials[index_of(id)];
  const auto* mix = std::get_if<Mix>(&material.kind);
  if (mix == nullptr) {
    return opacity(material, textures, point);
  }
  const double amount = amount_at(*mix, textures, point);
  return (1 - amount) * opacity(materials, mix->a, textures, point) +
         amount * opacity(materials, mix->b, textures, point);
}

}  // namespace bandsaw
