#pragma once

// Removes motion from instances that do not move during the shutter interval, so that it costs
// nothing.

#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Gives instances whose frames are static during the interval a fixed placement, equal to the bit
/// to the animated one at any time of it.
void make_static(const Interval& interval, Geometry& geometry);

/// Returns true if any instance still moves.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
