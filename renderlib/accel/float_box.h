#pragma once

// Bounding boxes in float, rounded outwards; the boxes of BVHs.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "renderlib/geometry/box.h"

namespace bandsaw {

struct FloatBox {
  static constexpr float kInf = std::numeric_limits<float>::infinity();

  /// The box is empty by default: no ray hits it, and no tree accepts it.
  std::array<float, 3> lo{kInf, kInf, kInf};
  std::array<float, 3> hi{-kInf, -kInf, -kInf};

  void add(const FloatBox& other) {
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = other.lo[k] < lo[k] ? other.lo[k] : lo[k];
      hi[k] = other.hi[k] > hi[k] ? other.hi[k] : hi[k];
    }
  }
  /// Returns half the surface area, 0 if empty. It is computed in double, because products of
  /// floats may overflow.
  double area() const {
    const double x = double{hi[0]} - double{lo[0]};
    const double y = double{hi[1]} - double{lo[1]};
    const double z = double{hi[2]} - double{lo[2]};
    return x >= 0 ? x * y + y * z + z * x : 0;
  }
  /// Returns true if the box is neither empty nor infinite.
  bool can_be_hit() const {
    bool good = true;
    for (std::size_t k = 0; k < 3; ++k) {
      good = good && lo[k] <= hi[k] && std::isfinite(lo[k]) && std::isfinite(hi[k]);
    }
    return good;
  }
  /// Returns the largest absolute coordinate.
  float reach() const {
    float most = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max({most, std::abs(lo[k]), std::abs(hi[k])});
    }
    return most;
  }
};

/// round_down() returns the largest float that is not above x, round_up() the smallest that is not
/// below x.
inline float round_down(double x) {
  const auto f = static_cast<float>(x);
  return double{f} > x ? std::nextafter(f, -FloatBox::kInf) : f;
}
inline float round_up(double x) {
  const auto f = static_cast<float>(x);
  return double{f} < x ? std::nextafter(f, FloatBox::kInf) : f;
}

/// Returns the smallest float box that contains `box`.
inline FloatBox round_outwards(const Box& box) {
  return {{round_down(box.lo.x), round_down(box.lo.y), round_down(box.lo.z)},
          {round_up(box.hi.x), round_up(box.hi.y), round_up(box.hi.z)}};
}

}  // namespace bandsaw
