#pragma once

// Bounds of instances: a box for one at rest, a box with linearly moving sides for one that moves
// during the shutter interval.

#include <optional>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/interval.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the world box of a placed box, enlarged by `trips` times the rounding error of a ray
/// that is transformed to the instance and back.
Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object,
                  double trips = 1);

/// At a share u of the interval, everything lies within (1 - u) at_open + u at_close.
struct MovingBox {
  Box at_open;
  Box at_close;
};

/// Returns the bounds of `box`, given in the instance's own space, enlarged for the rounding error
/// of rays that are transformed to the instance and back, during Geometry::shutter. The instance
/// MUST have a frame. Returns std::nullopt if a placement during the interval is singular.
std::optional<MovingBox> moving_bounds(const Geometry& geometry, const Instance& instance,
                                       const Box& box);

}  // namespace bandsaw
