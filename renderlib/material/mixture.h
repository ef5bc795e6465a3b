#pragma once

// Mixtures (Mix): at each point one of two materials is present, at random.

#include <algorithm>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/math/rgb.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Maximum number of materials that a mixture is made of, nested mixtures and itself included. A
/// material that occurs several times counts several times.
inline constexpr std::uint64_t kMaxMixtureParts = 256;

/// Returns the probability of the second part at the point.
inline double amount_at(const Mix& mix, absl::Span<const Texture> textures,
                        const SurfacePoint& point) {
  return std::clamp(double{luminance(look_up(textures, mix.amount, point))}, 0.0, 1.0);
}

/// Returns the material that is present at a point of a surface of material `id`. The result is
/// never a mixture. If material `id` is a mixture, u in [0, 1) selects one of its parts. If this
/// part is a mixture too, u also selects a part of it, and so on.
inline MaterialId part_at(absl::Span<const Material> materials, absl::Span<const Texture> textures,
                          MaterialId id, const SurfacePoint& point, double u) {
  // The parts of a mixture precede it, so there are fewer steps than materials.
  for (std::size_t step = 0; step < materials.size(); ++step) {
    const auto* mix = std::get_if<Mix>(&materials[index_of(id)].kind);
    if (mix == nullptr) {
      break;
    }
    const double amount = amount_at(*mix, textures, point);
    const bool second = u < amount;
    u = second ? u / amount : (u - amount) / (1 - amount);
    id = second ? mix->b : mix->a;
  }
  return id;
}

}  // namespace bandsaw
