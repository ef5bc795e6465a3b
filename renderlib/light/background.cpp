// The background's radiance: the environment map, or an interpolation between two colours by the
// direction's height.

#include "renderlib/light/background.h"

namespace bandsaw {

Rgb radiance(const Background& background, absl::Span<const Texture> textures,
             const Vec3& unit_direction) {
  if (background.environment) {
    return radiance(*background.environment, textures, unit_direction);
  }
  if (background.bottom == background.top) {
    return background.top;  // An interpolation between equal colours might round.
  }
  return lerp(background.bottom, background.top, static_cast<float>((unit_direction.y + 1) / 2));
}

}  // namespace bandsaw
