#pragma once

// A ray prepared for the float tests of boxes and packs. The direction is divided by `scale`, a
// power of two, so that its longest component is in [1, 2). Distances are t times `scale`.
// README.md derives the tests' margins for rounding.

#include <array>
#include <cstddef>
#include <limits>

#include "renderlib/geometry/traced_ray.h"

namespace bandsaw {

struct FloatRay {
  /// The ray enters the slab of axis k through the plane in row near[k] of WideNode::bounds, and
  /// leaves the slab through the plane in row far[k]. Rows are given as byte offsets
  /// (WideNode::plane). The distance to a plane at coordinate b is b * factor + offset.
  std::array<std::size_t, 3> near;
  std::array<std::size_t, 3> far;
  std::array<float, 3> near_factor;
  std::array<float, 3> near_offset;
  std::array<float, 3> far_factor;
  std::array<float, 3> far_offset;

  std::array<float, 3> origin;
  std::array<float, 3> direction;  ///< scaled
  float origin_size;               ///< at least |origin|_1; bounds the rounding of the origin
  float direction_size;            ///< at least |direction|_1
  float length;                    ///< at least |direction|, at most (1 + 2^-19) |direction|
  /// Added to every error bound, for underflow. It is infinite if the numbers are so large that
  /// float may overflow. In that case the float tests of primitives decide nothing.
  float floor;
  double scale;

  /// `reach` is the largest absolute coordinate of the geometry to be tested.
  FloatRay(const TracedRay& ray, float reach);

  /// below() and above() return t in this ray's units, rounded down or up by more than the rounding
  /// error of box distances.
  float below(double t) const { return static_cast<float>(t * scale * (1 - 0x1p-20)); }
  float above(double t) const { return static_cast<float>(t * scale * (1 + 0x1p-20)); }

 private:
  /// Sets element k of each of the arrays from `near` to `far_offset`. `from` is component k of the
  /// origin, `factor` is 1 / component k of the scaled direction; `slack` is added to the margin
  /// for rounding.
  void set_planes(std::size_t k, double from, float factor, double slack);
  /// Lets the ray enter all boxes.
  void disable_culling();
};

}  // namespace bandsaw
