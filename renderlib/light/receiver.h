#pragma once

// A receiver is a place at which light is received. The structs describe what light sampling
// (light/lights.h) has to know about the place.

#include <algorithm>
#include <optional>

#include "renderlib/math/cone.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// A ray segment in a scattering medium. Lights are weighted by their contribution along the whole
/// segment.
struct ReceiverSegment {
  Vec3 origin;
  Vec3 direction;         ///< unit
  double length = 0;      ///< > 0, maybe infinite
  double extinction = 0;  ///< > 0, the mean of the channels

  /// Returns the distance along the segment at which it is closest to a point.
  double nearest(const Vec3& to) const {
    return std::clamp(dot(to - origin, direction), 0.0, length);
  }
};

/// A point that receives light. With a normal, it is on a surface and receives light on one side.
/// Without a normal, it is in a medium and receives light from all directions. If `within` is set,
/// the receiver is instead the point on which the camera's lens is focused. Light from beyond this
/// point passes through the point to the lens (integrate/through_lens.h).
struct Receiver {
  Vec3 position;
  /// Unit; light arrives only from directions with a positive cosine to it.
  std::optional<Vec3> normal = std::nullopt;
  double time = 0;  ///< lights are evaluated at this time

  /// If this is set, only lights that may be visible within the cone are sampled. Distant lights
  /// are not sampled then. The cone MUST outlive the receiver.
  const Cone* within = nullptr;

  /// Returns true if light can arrive from `direction`, which may have any length.
  bool faces(const Vec3& direction) const {
    return (!normal || dot(*normal, direction) > 0) &&
           (within == nullptr || within->contains(direction));
  }
};

}  // namespace bandsaw
