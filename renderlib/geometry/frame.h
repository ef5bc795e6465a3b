#pragma once

// Spaces that move. What is placed in a frame moves along; frames may move within frames.
//
// Between two keys translation and scale change linearly and the rotation by the shortest way at
// constant speed (Shoemake 1985, "Animating Rotation with Quaternion Curves", section 3.3). At a
// key, before the first and after the last, the frame is exactly what the key says.

#include <optional>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/math/quaternion.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

inline constexpr FrameId kNoFrame{0xffffffffu};

/// Translation after rotation after scale. Of a placement that mirrors all three scales are
/// negative.
struct Pose {
  Vec3 translate;
  Quaternion rotate;
  Vec3 scale{1, 1, 1};
};

/// Nothing where the map is no such product to 1e-9 of its size: where it shears, or is singular.
std::optional<Pose> decompose(const Transform& t);

/// Where a frame is at one time.
struct Key {
  Key() = default;
  /// A transform that cannot be decomposed keeps Pose{} (see is_rigid).
  Key(double when, const Transform& where);

  double time = 0;
  Transform at;
  Pose pose;  ///< `at`, decomposed
};

struct Frame {
  FrameId parent = kNoFrame;  ///< an earlier frame: what this one moves in
  Transform placement;        ///< of this frame in its parent, before it moves; regular
  std::vector<Key> keys;      ///< one at least; times rise
};

/// The movement alone, without parent and placement. `frame` MUST have a key.
Transform motion_at(const Frame& frame, double time);

/// From the frame to the world. `id` MUST name one of the frames, whose parents come before them.
Transform frame_at(const std::vector<Frame>& frames, FrameId id, double time);

}  // namespace bandsaw
