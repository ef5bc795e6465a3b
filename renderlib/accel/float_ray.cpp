// Converts a ray to float for the tests of boxes and triangles. The direction is scaled by a power
// of two; the planes of boxes are moved outwards by the rounding errors, which README.md, "Bounds",
// derives. If the numbers are so large that float could overflow, every ray enters every box.

#include "renderlib/accel/float_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "renderlib/accel/wide_tree.h"

namespace bandsaw {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
/// The number u of README.md: the largest relative error when a number is rounded to float.
constexpr double kUnit = 0x1p-24;
/// If lengths exceed kLargest, the product of four lengths, as in the triangle filter, may overflow
/// float.
constexpr double kLargest = 0x1p30;
/// If a length exceeds kLargestBox, its product with kSteepest, as in the box test, may overflow
/// float.
constexpr double kLargestBox = 0x1p60;
/// Largest factor of the box test, 1 / a component of the scaled direction. A larger factor, which
/// may be infinite, is replaced by this number.
constexpr double kSteepest = 0x1p60;
/// Bytes of a row of WideNode::bounds.
constexpr std::size_t kRow = sizeof(WideNode::bounds[0]);
/// An error bound far above the error of float underflow.
constexpr double kTiny = 0x1p-100;
/// A positive value times this factor, rounded to float, is not below the value.
constexpr double kUp = 1 + 0x1p-22;

}  // namespace

FloatRay::FloatRay(const TracedRay& ray, float reach) {
  const double longest = std::abs(ray.direction[static_cast<std::size_t>(ray.kz)]);
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(longest) & 0x7ff0000000000000u;
  scale = std::bit_cast<double>(exponent);
  // 1 / scale, exactly: the biased exponents of both add up to 2046, twice the bias.
  const double unscale = std::bit_cast<double>((std::uint64_t{2046} << 52) - exponent);
  double o1 = 0;  // |origin|_1
  double d1 = 0;  // |direction|_1
  double steepest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = ray.direction[k] * unscale;
    const double inverse = ray.inverse[k] * scale;
    origin[k] = static_cast<float>(ray.origin[k]);
    direction[k] = static_cast<float>(d);
    o1 += std::abs(ray.origin[k]);
    d1 += std::abs(d);
    steepest = std::max(steepest, std::abs(inverse));
    set_planes(k, ray.origin[k], static_cast<float>(inverse), kTiny);
  }
  origin_size = static_cast<float>(o1 * kUp);
  direction_size = static_cast<float>(d1 * kUp);
  floor = static_cast<float>(kTiny);
  length = std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                     direction[2] * direction[2]) *
           (1 + 0x1p-20f);
  const double largest = std::max(o1, double{reach});
  if (!(largest < kLargest)) [[unlikely]] {
    floor = kInf;
  }
  if (!(largest < kLargestBox)) [[unlikely]] {
    disable_culling();
  } else if (!(steepest <= kSteepest)) [[unlikely]] {
    for (std::size_t k = 0; k < 3; ++k) {
      if (!(std::abs(ray.inverse[k] * scale) <= kSteepest)) {
        const double factor = std::copysign(kSteepest, ray.inverse[k]);
        set_planes(k, ray.origin[k], static_cast<float>(factor), 4 * (o1 + double{reach}));
      }
    }
  }
}

// The distance to a plane at b is b * factor + offset. The margin makes distances to near planes
// smaller and distances to far planes larger; the latter are also multiplied by 1 + 8 u. So in
// float the ray enters a box no later, and leaves it no earlier, than in exact numbers.
void FloatRay::set_planes(std::size_t k, double from, float factor, double slack) {
  const std::size_t backwards = std::signbit(factor) ? 3 * kRow : 0;
  near[k] = k * kRow + backwards;
  far[k] = (k + 3) * kRow - backwards;
  near_factor[k] = factor;
  far_factor[k] = factor * static_cast<float>(1 + 8 * kUnit);
  const double near_at = from * double{near_factor[k]};
  const double far_at = from * double{far_factor[k]};
  const double margin = 5 * kUnit * std::abs(near_at) + slack;
  near_offset[k] = static_cast<float>(-near_at - margin);
  far_offset[k] = static_cast<float>(-far_at + margin);
}

void FloatRay::disable_culling() {
  for (std::size_t k = 0; k < 3; ++k) {
    near_factor[k] = 0;
    far_factor[k] = 0;
    near_offset[k] = -kInf;
    far_offset[k] = kInf;
  }
}

}  // namespace bandsaw
