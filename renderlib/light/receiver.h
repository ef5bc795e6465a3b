#pragma once

#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// A point that receives light: on a surface, from one side of it; without a normal (in a medium)
/// from all around.
struct Receiver {
  Vec3 position;
  /// Unit; light comes only from directions with a positive cosine to it.
  std::optional<Vec3> normal = std::nullopt;
  double time = 0;  ///< lights are where they are then

  /// Whether light can come from that way, of any length.
  bool faces(const Vec3& way) const { return !normal || dot(*normal, way) > 0; }
};

}  // namespace bandsaw
