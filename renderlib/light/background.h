#pragma once

// What a ray sees that leaves the scene.

#include <optional>

#include "absl/types/span.h"
#include "renderlib/light/environment.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The environment, or where there is none: radiance(d) = lerp(bottom, top, (d.y + 1) / 2) for a
/// unit direction d; constant when both are equal.
struct Background {
  Rgb bottom;
  Rgb top;
  std::optional<Environment> environment = std::nullopt;
};

/// `textures` are those of the scene.
Rgb radiance(const Background& background, absl::Span<const Texture> textures,
             const Vec3& unit_direction);

}  // namespace bandsaw
