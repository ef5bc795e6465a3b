#include <cmath>
#include <limits>

#include "renderlib/math/elementary.h"
#include "renderlib/math/fused.h"
#include "renderlib/math/polynomial.h"

// atan(y / x) = atan(t) + atan((y - t x) / (x + t y)), where t is the multiple of 1/8 that is
// nearest to y / x. t has so few bits that the numerator is rounded only once. asin(x) is the angle
// of the point (sqrt(1 - x^2), x), and acos(x) is the angle of (x, sqrt(1 - x^2)). In both
// functions, 1 - x^2 is rounded once as well.

namespace bandsaw {
namespace {

/// pi / 2 as the sum of two doubles.
constexpr TwoDoubles kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/// Element k is atan(k / 8) as the sum of two doubles.
constexpr TwoDoubles kAtanEighths[] = {
    {0, 0},
    {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
    {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
    {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
    {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
    {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
    {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
    {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
    {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55},
};

/// Returns atan(z) - z for |z| <= 1/16.
double atan_rest(double z) {
  static constexpr double kAtan[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7, 1.0 / 9,
                                     -1.0 / 11, 1.0 / 13, -1.0 / 15};
  const double square = z * z;
  return z * square * polynomial(square, kAtan);
}

/// Returns atan(y / x) for 0 <= y <= x, x > 0.
TwoDoubles atan_octant(double y, double x) {
  const double k = std::nearbyint(8 * (y / x));
  const double t = k / 8;
  const double numerator = fused(-t, x, y);
  const double denominator = fused(t, y, x);
  const double z = numerator / denominator;
  // This is the rounding error of the division.
  const double z_rest = fused(-z, denominator, numerator) / denominator;
  const TwoDoubles& base = kAtanEighths[static_cast<int>(k)];
  const TwoDoubles sum = two_sum(base.hi, z);
  return {sum.hi, sum.lo + (base.lo + (atan_rest(z) + z_rest))};
}

/// Returns quarters * pi / 2 + sign * a, rounded to double.
double from_quarter(double quarters, double sign, const TwoDoubles& a) {
  const TwoDoubles sum = two_sum(quarters * kHalfPi.hi, sign * a.hi);
  return sum.hi + (sum.lo + fused(quarters, kHalfPi.lo, sign * a.lo));
}

/// Returns the angle of (x, y) for y >= 0, in [0, pi].
double upper_angle(double y, double x) {
  const double width = std::abs(x);
  if (y <= width) {
    const TwoDoubles a = atan_octant(y, width);
    return x < 0 ? from_quarter(2, -1, a) : a.hi + a.lo;
  }
  return from_quarter(1, x < 0 ? 1 : -1, atan_octant(width, y));
}

double clamp_to_one(double x) { return x > 1 ? 1 : x < -1 ? -1 : x; }

}  // namespace

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (std::isinf(x) || std::isinf(y)) {
    x = std::isinf(x) ? std::copysign(1.0, x) : 0;
    y = std::isinf(y) ? std::copysign(1.0, y) : 0;
  }
  if (y == 0) {
    return x < 0 ? 2 * kHalfPi.hi : 0;
  }
  // Rescales away from the ends of the range, where sums overflow and products lose precision.
  const double size = std::abs(x) > std::abs(y) ? std::abs(x) : std::abs(y);
  if (size > 0x1p1000 || size < 0x1p-900) {
    const double scale = size > 1 ? 0x1p-100 : 0x1p150;
    x *= scale;
    y *= scale;
  }
  const double angle = upper_angle(std::abs(y), x);
  return y < 0 ? -angle : angle;
}

double asin(double x) {
  const double c = clamp_to_one(x);
  return atan2(c, std::sqrt(fused(-c, c, 1.0)));
}

double acos(double x) {
  const double c = clamp_to_one(x);
  return atan2(std::sqrt(fused(-c, c, 1.0)), c);
}

}  // namespace bandsaw
