#pragma once

// The radiance of the background, which rays that leave the scene see. Path tracing adds it
// (integrate/path.cpp); light sampling covers only the non-uniform part of an environment map
// (light/environment_light.h).

#include <optional>

#include "absl/types/span.h"
#include "renderlib/light/environment.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// An environment map or, without one, a vertical gradient: radiance(d) = lerp(bottom, top, (d.y +
/// 1) / 2) for a unit direction d. The gradient is constant if both colours are equal.
struct Background {
  Rgb bottom;
  Rgb top;
  std::optional<Environment> environment = std::nullopt;
};

/// Returns true if the background is black for certain: it has no environment map and its colours
/// are black.
inline bool is_black(const Background& background) {
  return !background.environment && is_black(background.bottom) && is_black(background.top);
}

/// Returns the background radiance in a unit direction. `textures` are the scene's textures.
Rgb radiance(const Background& background, absl::Span<const Texture> textures,
             const Vec3& unit_direction);

}  // namespace bandsaw
