#pragma once

// Eight triangles in float, in structure-of-arrays layout. Triangles of a mesh hold the vertices
// exactly; a loose triangle is rounded, a quad is two triangles that share its diagonal and its id.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderlib/accel/binary_tree.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

struct FlatPack {
  static_assert(kPackSize == kCornerStride, "hits refer to corners");

  /// [3 * corner + axis][lane]; unused lanes are zero.
  using Corners = std::array<std::array<float, kPackSize>, 9>;
  Corners corner;
  std::array<std::uint32_t, kPackSize> primitive;
  /// At least the absolute value of every component of every edge. If corners were rounded, four
  /// times their largest component is added (README.md, "Triangles"). If they move, it holds for
  /// all times.
  float size;
  std::uint32_t lanes;  ///< bit i: lane i is used

  std::array<float, 3> vertex(std::size_t lane, std::size_t which) const {
    return {corner[3 * which][lane], corner[3 * which + 1][lane], corner[3 * which + 2][lane]};
  }
};

/// Fills a pack, one triangle after another.
class FlatPacker {
 public:
  using Corners = std::array<std::array<float, 3>, 3>;

  explicit FlatPacker(FlatPack& pack) : pack_(pack) { pack_ = {}; }
  void add(const Corners& corners, std::uint32_t primitive);
  /// Adds a triangle whose corners were rounded from double.
  void add_rounded(const Corners& corners, std::uint32_t primitive);
  /// Adds a triangle that moves; its corners at the end of the interval are stored in `to`.
  void add_moving(const Corners& at_open, const Corners& at_close, std::uint32_t primitive,
                  FlatPack::Corners& to);

 private:
  FlatPack& pack_;
  std::size_t count_ = 0;
};

}  // namespace bandsaw
