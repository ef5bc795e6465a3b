#pragma once

// Takes motion out of what does not move while the shutter is open: it costs nothing then.

#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Instances whose frames stand still during the interval get their place in the world for good,
/// the same to the bit as at any time of it.
void rest(const Interval& interval, Geometry& geometry);

/// Whether any instance is left that moves.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
