#pragma once

#include <algorithm>
#include <optional>

#include "renderlib/math/cone.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// A stretch of a ray in a medium that scatters: lights are judged by what they give all along it.
struct LitStretch {
  Vec3 origin;
  Vec3 way;               ///< unit
  double length = 0;      ///< > 0, maybe infinite
  double extinction = 0;  ///< > 0, the mean of the channels

  /// How far along it is nearest to a point.
  double nearest(const Vec3& to) const { return std::clamp(dot(to - origin, way), 0.0, length); }
};

/// A point that receives light: on a surface, from one side of it; without a normal (in a medium)
/// from all around. Or a point through which light is seen.
struct Receiver {
  Vec3 position;
  /// Unit; light comes only from directions with a positive cosine to it.
  std::optional<Vec3> normal = std::nullopt;
  double time = 0;  ///< lights are where they are then

  /// Where it is set, lights are asked that may be seen within it, and no distant ones. Outlives
  /// the receiver.
  const Cone* within = nullptr;

  /// Whether light can come from that way, of any length.
  bool faces(const Vec3& way) const {
    return (!normal || dot(*normal, way) > 0) && (within == nullptr || within->contains(way));
  }
};

}  // namespace bandsaw
