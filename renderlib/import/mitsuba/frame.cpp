// Splits the transform of a Mitsuba sensor or emitter into position, axes and scale. Notes whether
// the transform mirrors, and whether it skews.

#include "renderlib/import/mitsuba/frame.h"

#include <cmath>

namespace bandsaw::mitsuba {

Frame frame_of(const Transform& to_world) {
  const Vec3 x = to_world.direction({1, 0, 0});
  const Vec3 y = to_world.direction({0, 1, 0});
  const Vec3 z = to_world.direction({0, 0, 1});
  Frame frame;
  frame.position = to_world.point({0, 0, 0});
  frame.scale = {length(x), length(y), length(z)};
  frame.ahead = normalize(z);
  frame.up = normalize(y);
  frame.mirrored = determinant(to_world) < 0;
  const Vec3 side = normalize(x);
  frame.skewed = std::abs(dot(frame.ahead, frame.up)) > 1e-6 ||
                 std::abs(dot(frame.ahead, side)) > 1e-6 || std::abs(dot(frame.up, side)) > 1e-6;
  return frame;
}

}  // namespace bandsaw::mitsuba
