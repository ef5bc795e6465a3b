#include "renderlib/accel/flat_pack.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {

void FlatPacker::add(const Corners& corners, std::uint32_t primitive) {
  const std::size_t lane = count_++;
  for (std::size_t which = 0; which < 3; ++which) {
    for (std::size_t k = 0; k < 3; ++k) {
      pack_.corner[3 * which + k][lane] = corners[which][k];
      // Twice the rounding of the difference itself.
      const float edge = std::abs(corners[which][k] - corners[0][k]) * (1 + 0x1p-22f);
      pack_.size = std::max(pack_.size, edge);
    }
  }
  pack_.primitive[lane] = primitive;
  pack_.lanes |= 1u << lane;
}

void FlatPacker::add_rounded(const Corners& corners, std::uint32_t primitive) {
  add(corners, primitive);
  float edge = 0;
  float reach = 0;
  for (std::size_t which = 0; which < 3; ++which) {
    for (std::size_t k = 0; k < 3; ++k) {
      edge = std::max(edge, std::abs(corners[which][k] - corners[0][k]));
      reach = std::max(reach, std::abs(corners[which][k]));
    }
  }
  pack_.size = std::max(pack_.size, (edge + 4 * reach) * (1 + 0x1p-20f));
}

}  // namespace bandsaw
