#pragma once

// Computes the vertices of a mesh at a time of the shutter interval. At each time, a mesh that
// deforms is an ordinary mesh with float positions. Tracing, shading and light sampling all use
// these functions, so they get the same positions, bit for bit.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderlib/geometry/interval.h"
#include "renderlib/geometry/mesh.h"
#include "renderlib/math/fused.h"

namespace bandsaw {

/// A time within the shutter interval, prepared for the interpolation of numbers between the
/// beginning and the end of the interval.
struct ShutterTime {
  /// A time outside the interval counts as its nearest end. If the interval is one instant, `share`
  /// is 0.
  ShutterTime(const Interval& shutter, double time) {
    const double u = (time - shutter.open) / (shutter.close - shutter.open);
    share = u > 0 ? u < 1 ? static_cast<float>(u) : 1.0f : 0.0f;
    from_close = share > 0.5f;
    factor = from_close ? share - 1 : share;
  }

  /// Interpolates linearly between two numbers. A part of the change is added to the number at the
  /// end that is nearer in time, and the sum is rounded once. So the result is exact at both ends,
  /// never outside of the range between the two numbers, and constant if the numbers are equal.
  float between(float at_open, float at_close) const {
    return fused(at_close - at_open, factor, from_close ? at_close : at_open);
  }
  std::array<float, 3> between(const std::array<float, 3>& at_open,
                               const std::array<float, 3>& at_close) const {
    return {between(at_open[0], at_close[0]), between(at_open[1], at_close[1]),
            between(at_open[2], at_close[2])};
  }

  float share = 0;          ///< [0, 1]: 0 at the beginning, 1 at the end
  bool from_close = false;  ///< true in the second half
  float factor = 0;         ///< factor on the change, in [-1/2, 1/2]; exact
};

inline bool deforms(const Mesh& mesh) { return !mesh.positions_at_close.empty(); }

/// Returns the values of a triangle's corners, e.g. positions or normals, at a time. `corner` holds
/// the indices of the corners. If `at_close` is empty, the values do not change.
inline std::array<std::array<float, 3>, 3> corners_at(
    const std::vector<std::array<float, 3>>& at_open,
    const std::vector<std::array<float, 3>>& at_close, const std::array<std::uint32_t, 3>& corner,
    const Interval& shutter, double time) {
  if (at_close.empty()) {
    return {at_open[corner[0]], at_open[corner[1]], at_open[corner[2]]};
  }
  const ShutterTime now(shutter, time);
  const auto vertex = [&](std::size_t i) {
    return now.between(at_open[corner[i]], at_close[corner[i]]);
  };
  return {vertex(0), vertex(1), vertex(2)};
}

/// Returns the positions of a triangle's corners at a time.
inline std::array<std::array<float, 3>, 3> corners_at(const Mesh& mesh, std::size_t triangle,
                                                      const Interval& shutter, double time) {
  return corners_at(mesh.positions, mesh.positions_at_close, mesh.triangles[triangle], shutter,
                    time);
}

}  // namespace bandsaw
