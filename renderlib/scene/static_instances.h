#pragma once

// Finds instances that are animated but do not move while the shutter is open, and makes them
// static, because rays are traced faster through static instances. Scene::build calls it.

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Each instance whose frames have the same transform throughout Geometry::shutter gets this
/// transform as a fixed placement, and no frame. The fixed placement has the same bits as the one
/// that was computed from the frames before, so no pixel changes.
void make_static(Geometry& geometry);

/// Returns true if any instance still moves or deforms.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
