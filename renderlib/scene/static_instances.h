#pragma once

// Removes motion from instances that do not move during the shutter interval, so that it costs
// nothing.

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Gives instances whose frames are static during Geometry::shutter a fixed placement, equal to the
/// bit to the animated one at any time of it.
void make_static(Geometry& geometry);

/// Returns true if any instance still moves or deforms.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
