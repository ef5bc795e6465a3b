#pragma once

// Opacity of a surface at a point: glTF's alpha, and 0 for glass that does not refract.

#include <algorithm>
#include <cmath>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Boundaries whose relative index of refraction is closer to 1 do not refract.
inline constexpr double kMinRefraction = 1e-6;

/// Returns true for glass with the same index as its surroundings, through which light goes
/// straight on. Glass with a priority excludes other glass and therefore counts as present.
inline bool bends_nothing(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material);
  return glass != nullptr && glass->priority == 0 && !glass->index_map &&
         std::abs(glass->index_of_refraction - 1) < kMinRefraction;
}

/// Returns true if opacity() can be other than 1.
inline bool has_alpha(const Material& material) {
  if (bends_nothing(material)) {
    return true;
  }
  const auto* principled = std::get_if<Principled>(&material);
  return principled != nullptr && principled->alpha_mode != AlphaMode::kOpaque;
}

/// Returns the probability that a ray is stopped here, in [0, 1].
inline double opacity(const Material& material, absl::Span<const Texture> textures,
                      const SurfacePoint& point) {
  if (!has_alpha(material)) {
    return 1;
  }
  if (bends_nothing(material)) {
    return 0;
  }
  const auto& principled = std::get<Principled>(material);
  const Channel& channel = principled.alpha;
  const double texel = look_up(textures, channel.texture, point).r;
  const double alpha = std::clamp(channel.factor * texel, 0.0, 1.0);
  if (principled.alpha_mode == AlphaMode::kMask) {
    return alpha >= principled.alpha_cutoff ? 1 : 0;
  }
  return alpha;
}

}  // namespace bandsaw
