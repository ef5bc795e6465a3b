// Fills a pack with triangles and updates its `size`, which bounds the components of all edges. The
// float filter (flat_filter.h) is a test in float that rejects a triangle only if the exact test in
// double would reject it as well. The filter computes its error bound from `size` (README.md,
// "Triangles"). In the comments, u is 2^-24, the largest relative error when a number is rounded to
// float.

#include "renderlib/accel/flat_pack.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {

namespace {

/// Returns the largest absolute component of the edges from the first corner.
float longest(const FlatPacker::Corners& corners) {
  float most = 0;
  for (std::size_t which = 1; which < 3; ++which) {
    for (std::size_t k = 0; k < 3; ++k) {
      most = std::max(most, std::abs(corners[which][k] - corners[0][k]));
    }
  }
  return most;
}

/// Returns the largest absolute coordinate of the corners.
float reach_of(const FlatPacker::Corners& corners) {
  float reach = 0;
  for (const std::array<float, 3>& corner : corners) {
    for (const float x : corner) {
      reach = std::max(reach, std::abs(x));
    }
  }
  return reach;
}

/// Copies the corners of one triangle to a lane of `to`.
void store(const FlatPacker::Corners& corners, std::size_t lane, FlatPack::Corners& to) {
  for (std::size_t which = 0; which < 3; ++which) {
    for (std::size_t k = 0; k < 3; ++k) {
      to[3 * which + k][lane] = corners[which][k];
    }
  }
}

}  // namespace

void FlatPacker::add(const Corners& corners, std::uint32_t primitive) {
  const std::size_t lane = count_++;
  store(corners, lane, pack_.corner);
  pack_.primitive[lane] = primitive;
  pack_.lanes |= 1u << lane;
  // The factor covers the rounding of an edge, which is at most u, with a reserve.
  pack_.size = std::max(pack_.size, longest(corners) * (1 + 0x1p-22f));
}

// The corners were rounded from double, so each coordinate is wrong by at most u times reach_of().
// The error bound of the filter grows with `size`. It covers the errors of the corners if four
// times reach_of() is added to the longest edge (README.md, "Triangles", derives this number). The
// factor covers the rounding of the sum.
void FlatPacker::add_rounded(const Corners& corners, std::uint32_t primitive) {
  add(corners, primitive);
  pack_.size = std::max(pack_.size, (longest(corners) + 4 * reach_of(corners)) * (1 + 0x1p-20f));
}

void FlatPacker::add_moving(const Corners& at_open, const Corners& at_close,
                            std::uint32_t primitive, FlatPack::Corners& to) {
  store(at_close, count_, to);
  add(at_open, primitive);
  // Edges change linearly, so the largest absolute component occurs at one of the two ends. The
  // second term covers the rounding of an edge's two corners. The rounding of one corner is at most
  // 2u times the largest coordinate.
  pack_.size = std::max(pack_.size, (std::max(longest(at_open), longest(at_close)) +
                                     std::max(reach_of(at_open), reach_of(at_close)) * 0x1p-21f) *
                                        (1 + 0x1p-20f));
}

}  // namespace bandsaw
