#pragma once

// A leaf of a BVH: up to eight triangles in float, in structure-of-arrays layout. Corners of mesh
// triangles are exact; corners of triangles that belong to no mesh are rounded from double. A quad
// is stored as two triangles that share its diagonal and its number.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderlib/accel/binary_tree.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

struct FlatPack {
  static_assert(kPackSize == kCornerStride, "Hit::corners has the stride kCornerStride");

  /// [3 * corner + axis][lane]; unused lanes are zero.
  using Corners = std::array<std::array<float, kPackSize>, 9>;
  Corners corner;
  std::array<std::uint32_t, kPackSize> primitive;  ///< [lane]: as in PrimitiveId
  /// At least the absolute value of every component of every edge. If corners were rounded, four
  /// times their largest component is added (README.md, "Triangles"). If corners move, `size` is
  /// valid for all times.
  float size;
  std::uint32_t lanes;  ///< bit i: lane i is used

  /// Returns corner `which` (0 to 2) of the triangle in a lane.
  std::array<float, 3> vertex(std::size_t lane, std::size_t which) const {
    return {corner[3 * which][lane], corner[3 * which + 1][lane], corner[3 * which + 2][lane]};
  }
};

/// Fills a pack, one triangle after another, at most kPackSize.
class FlatPacker {
 public:
  /// [corner][axis] of one triangle.
  using Corners = std::array<std::array<float, 3>, 3>;

  explicit FlatPacker(FlatPack& pack) : pack_(pack) { pack_ = {}; }
  /// Adds a triangle whose corners are exact. `primitive` is its number, as in PrimitiveId.
  void add(const Corners& corners, std::uint32_t primitive);
  /// Adds a triangle whose corners were rounded from double.
  void add_rounded(const Corners& corners, std::uint32_t primitive);
  /// Adds a triangle of a mesh that deforms. The pack gets the corners at the beginning of the
  /// shutter interval, and `to` gets the corners at its end.
  void add_moving(const Corners& at_open, const Corners& at_close, std::uint32_t primitive,
                  FlatPack::Corners& to);

 private:
  FlatPack& pack_;
  std::size_t count_ = 0;
};

}  // namespace bandsaw
