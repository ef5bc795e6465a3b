#pragma once

// How much of a surface is there at a point: what glTF calls alpha.

#include <algorithm>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Whether opacity() can be other than 1.
inline bool has_alpha(const Material& material) {
  const auto* principled = std::get_if<Principled>(&material);
  return principled != nullptr && principled->alpha_mode != AlphaMode::kOpaque;
}

/// The probability that a ray is stopped here, in [0, 1].
inline double opacity(const Material& material, absl::Span<const Texture> textures,
                      const SurfacePoint& point) {
  if (!has_alpha(material)) {
    return 1;
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
