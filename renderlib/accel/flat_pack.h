#pragma once

// Eight triangles side by side in float. For mesh triangles these are the vertices themselves; a
// loose triangle is rounded, a quad is two of them that share its diagonal and its id.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderlib/accel/binary_tree.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

struct FlatPack {
  static_assert(kPackSize == kCornerStride, "hits refer to corners");

  /// [3 * corner + axis][lane]; lanes past the last are zero.
  std::array<std::array<float, kPackSize>, 9> corner;
  std::array<std::uint32_t, kPackSize> primitive;
  /// At least every component of every edge; where corners were rounded, plus four times the
  /// largest of their components (README.md, "Triangles").
  float size;
  std::uint32_t lanes;  ///< bit i: lane i is a triangle

  std::array<float, 3> vertex(std::size_t lane, std::size_t which) const {
    return {corner[3 * which][lane], corner[3 * which + 1][lane], corner[3 * which + 2][lane]};
  }
};

/// Fills packs, one triangle after another.
class FlatPacker {
 public:
  using Corners = std::array<std::array<float, 3>, 3>;

  explicit FlatPacker(FlatPack& pack) : pack_(pack) { pack_ = {}; }
  void add(const Corners& corners, std::uint32_t primitive);
  /// Corners that were rounded from double.
  void add_rounded(const Corners& corners, std::uint32_t primitive);

 private:
  FlatPack& pack_;
  std::size_t count_ = 0;
};

}  // namespace bandsaw
