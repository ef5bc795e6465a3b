#pragma once

// A ray as the float tests of boxes and packs want it. Its distances are t times `scale`, a power
// of two that brings the longest component of the direction into [1, 2). README.md derives what
// the tests add for rounding.

#include <array>
#include <cstddef>
#include <limits>

#include "renderlib/geometry/traced_ray.h"

namespace bandsaw {

struct FloatRay {
  /// Which of WideNode::bounds the ray enters and leaves axis k by, and where: bound * factor +
  /// offset. In bytes (WideNode::plane).
  std::array<std::size_t, 3> near;
  std::array<std::size_t, 3> far;
  std::array<float, 3> near_factor;
  std::array<float, 3> near_offset;
  std::array<float, 3> far_factor;
  std::array<float, 3> far_offset;

  std::array<float, 3> origin;
  std::array<float, 3> direction;  ///< scaled
  float origin_size;               ///< at least |origin|_1, which bounds its rounding
  float direction_size;            ///< at least |direction|_1
  float length;                    ///< at least |direction|, within 2^-19 of it
  /// Added to every bound for what underflows; infinite where numbers are so large that float may
  /// overflow: then nothing but boxes is decided in float.
  float floor;
  double scale;

  /// `reach`: the largest absolute coordinate of what is to be tested.
  FloatRay(const TracedRay& ray, float reach);

  /// t in this ray's units, rounded down and up by more than all roundings of box distances.
  float below(double t) const { return static_cast<float>(t * scale * (1 - 0x1p-20)); }
  float above(double t) const { return static_cast<float>(t * scale * (1 + 0x1p-20)); }

 private:
  void set_planes(std::size_t k, double from, float factor, double slack);
  void open_boxes();
};

}  // namespace bandsaw
