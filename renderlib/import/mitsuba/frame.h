#pragma once

// Computes the position and the axes of a sensor, spot, projector or environment from its transform
// to the world. In its own space, such an object looks along z, with y up and x to the left.

#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw::mitsuba {

struct Frame {
  Vec3 position;
  Vec3 ahead;             ///< unit
  Vec3 up;                ///< unit
  bool mirrored = false;  ///< in the world, x is to the right
  Vec3 scale{1, 1, 1};    ///< along x, y and z
  bool skewed = false;    ///< the axes are not at right angles
};

/// Returns the frame of a transform, which MUST have an inverse.
Frame frame_of(const Transform& to_world);

}  // namespace bandsaw::mitsuba
