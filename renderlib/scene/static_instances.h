#pragma once

// Finds instances that are animated but do not move while the shutter is open, and makes them
// static, because rays are traced faster through static instances. Scene::build calls it.

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Makes an instance static if the frames in which it is placed (coordinate systems that may move)
/// have constant transforms throughout Geometry::shutter. Such an instance gets its placement in
/// the world as `to_world`, and loses its frame. The new `to_world` has the same bits as the
/// placement that is computed from the frames, so no pixel changes.
void make_static(Geometry& geometry);

/// Returns true if any instance moves or deforms while the shutter is open.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
