// Fills the lanes of a pack one after the other. Numbers are rounded to float so that the float
// test cannot miss a sphere that the exact test hits. For this, radii are rounded upwards. The
// float test bounds the rounding errors of the centres by means of `reach`. For every sphere,
// `reach` is at least the radius plus the sum of the centre's |coordinates|.

#include "renderlib/accel/sphere_pack.h"

#include <algorithm>
#include <bit>

#include "renderlib/accel/float_box.h"

namespace bandsaw {

void SpherePack::add(const Sphere& sphere, std::uint32_t index) {
  const auto lane = static_cast<std::size_t>(std::popcount(lanes));
  double size = sphere.radius;
  for (int k = 0; k < 3; ++k) {
    center[static_cast<std::size_t>(k)][lane] = static_cast<float>(sphere.center[k]);
    size += std::abs(sphere.center[k]);
  }
  radius[lane] = round_up(sphere.radius);
  primitive[lane] = index;
  reach = std::max(reach, round_up(size));
  lanes |= 1u << lane;
}

}  // namespace bandsaw
