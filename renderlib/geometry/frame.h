#pragma once

// Animated coordinate frames (not images of a sequence). Instances that are placed in a frame move
// with it; frames can be nested.
//
// Between two keys, translation and scale are interpolated linearly and the rotation along the
// shortest arc at constant speed (Shoemake 1985, "Animating Rotation with Quaternion Curves",
// section 3.3). At a key, the frame has exactly the key's transform. Before the first key it has
// the first key's transform, and after the last key it has the last key's transform.

#include <optional>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/math/quaternion.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

inline constexpr FrameId kNoFrame{0xffffffffu};

/// The map p -> translate + rotate (scale p). If the map mirrors, all three scales are negative.
struct Pose {
  Vec3 translate;
  Quaternion rotate;
  Vec3 scale{1, 1, 1};
};

/// Returns the pose that equals `t`. Returns std::nullopt if there is none: `t` is singular, or it
/// shears, i.e. the pose found differs from `t` by more than 1e-9 of its largest element.
std::optional<Pose> decompose(const Transform& t);

/// The motion of a frame at one time; Frame::placement is applied after it.
struct Key {
  Key() = default;
  /// If `where` cannot be decomposed, `pose` stays Pose{}; validation refuses such keys.
  Key(double when, const Transform& where);

  double time = 0;
  Transform at;
  Pose pose;  ///< `at`, decomposed
};

struct Frame {
  FrameId parent = kNoFrame;  ///< an earlier frame, in which this one moves; kNoFrame: the world
  /// Placement of this frame in its parent, applied after its motion; invertible.
  Transform placement;
  std::vector<Key> keys;  ///< at least one; times strictly increase
};

/// Returns the transform that the keys give, without parent and placement. `frame` MUST have a key.
Transform motion_at(const Frame& frame, double time);

/// Returns the transform from the frame to the world. `id` MUST name one of the frames, whose
/// parents precede them.
Transform frame_at(const std::vector<Frame>& frames, FrameId id, double time);

}  // namespace bandsaw
