#pragma once

// Makes instances static that have keys of motion but do not move during the shutter interval, so
// that their motion costs no time. Scene::build calls it.

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Gives instances whose frames are static during Geometry::shutter a fixed placement and no frame.
/// The placement has the bits that the frames give at any time of that interval.
void make_static(Geometry& geometry);

/// Returns true if any instance still moves or deforms.
bool moves(const Geometry& geometry);

}  // namespace bandsaw
