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

}  // namespace

void FlatPacker::add(const Corners& corners, std::uint32_t primitive) {
  const std::size_t lane = count_++;
  for (std::size_t which = 0; which < 3; ++which) {
    for (std::size_t k = 0; k < 3; ++k) {
      pack_.corner[3 * which + k][lane] = corners[which][k];
    }
  }
  pack_.primitive[lane] = primitive;
  pack_.lanes |= 1u << lane;
  // The factor covers twice the rounding of the difference.
  pack_.size = std::max(pack_.size, longest(corners) * (1 + 0x1p-22f));
}

void FlatPacker::add_rounded(const Corners& corners, std::uint32_t primitive) {
  add(corners, primitive);
  float reach = 0;
  for (const std::array<float, 3>& corner : corners) {
    for (const float x : corner) {
      reach = std::max(reach, std::abs(x));
    }
  }
  pack_.size = std::max(pack_.size, (longest(corners) + 4 * reach) * (1 + 0x1p-20f));
}

}  // namespace bandsaw
