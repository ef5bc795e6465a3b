#include <cmath>
#include <limits>
#include <utility>

#include "renderlib/math/elementary.h"
#include "renderlib/math/fused.h"
#include "renderlib/math/polynomial.h"

// For sine and cosine, the angle is reduced exactly to at most an eighth of a turn, and represented
// as the sum of two doubles. Then Taylor series are evaluated. The first omitted term is below
// 2^-58 of the result, which is less than the rounding errors.

namespace bandsaw {
namespace {

/// 2 pi and pi / 180, each as the sum of two doubles.
constexpr TwoDoubles kTwoPi = {0x1.921fb54442d18p+2, 0x1.1a62633145c07p-52};
constexpr TwoDoubles kDegree = {0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};

/// Returns unit * r.
TwoDoubles scaled(const TwoDoubles& unit, double r) {
  const TwoDoubles product = two_product(unit.hi, r);
  return {product.hi, fused(unit.lo, r, product.lo)};
}

/// Sine and cosine, each as an unevaluated sum of two doubles.
struct Parts {
  TwoDoubles sin;
  TwoDoubles cos;
};

/// Returns sine and cosine of x; |x| is at most slightly more than pi/4.
Parts parts_reduced(const TwoDoubles& x) {
  static constexpr double kSin[] = {
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
  static constexpr double kCos[] = {
      1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
      1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
  const double square = x.hi * x.hi;
  // sin(hi + lo) = sin(hi) + lo (1 - hi^2 / 2) + …
  const double sin_rest =
      fused(square * x.hi, polynomial(square, kSin), fused(-0.5 * square, x.lo, x.lo));
  // cos(hi + lo) = 1 - hi^2 / 2 + (hi^4 (…) - hi lo). 1 - hi^2 / 2 is kept exactly, as a sum.
  const TwoDoubles half_square = two_product(0.5 * x.hi, x.hi);
  const TwoDoubles one_minus = fast_two_sum(1, -half_square.hi);
  const double cos_rest = fused(square * square, polynomial(square, kCos),
                                fused(-x.hi, x.lo, one_minus.lo - half_square.lo));
  return {{x.hi, sin_rest}, {one_minus.hi, cos_rest}};
}

SinCos sincos_reduced(const TwoDoubles& x) {
  const Parts p = parts_reduced(x);
  return {p.sin.hi + p.sin.lo, p.cos.hi + p.cos.lo};
}

/// Returns sine and cosine of an angle plus `count` quarter turns. `a` is sine and cosine of the
/// angle; `count` is an integer.
SinCos quarter_turns(const SinCos& a, double count) {
  const double count_mod_4 = count - 4 * std::floor(count / 4);
  switch (static_cast<int>(count_mod_4)) {
    case 0:
      return a;
    case 1:
      return {a.cos, -a.sin};
    case 2:
      return {-a.sin, -a.cos};
    default:
      return {-a.cos, a.sin};
  }
}

constexpr SinCos kUndefined = {std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::quiet_NaN()};

struct ReducedDegrees {
  double rest;      // in [-45, 45]
  double quarters;  // an integer
};

ReducedDegrees reduce_degrees(double degrees) {
  const double turn = std::fmod(degrees, 360.0);  // exact
  const double quarters = std::nearbyint(turn / 90);
  return {turn - 90 * quarters, quarters};
}

}  // namespace

SinCos sincos_turns(double u) {
  if (!std::isfinite(u)) {
    return kUndefined;
  }
  if (std::abs(u) >= 0x1p52) {
    return {0, 1};  // an integer
  }
  const double quarters = std::nearbyint(4 * u);
  return quarter_turns(sincos_reduced(scaled(kTwoPi, u - 0.25 * quarters)), quarters);
}

SinCos sincos_degrees(double degrees) {
  if (!std::isfinite(degrees)) {
    return kUndefined;
  }
  const ReducedDegrees r = reduce_degrees(degrees);
  return quarter_turns(sincos_reduced(scaled(kDegree, r.rest)), r.quarters);
}

double tan_degrees(double degrees) {
  if (!std::isfinite(degrees)) {
    return kUndefined.sin;
  }
  const ReducedDegrees r = reduce_degrees(degrees);
  const Parts p = parts_reduced(scaled(kDegree, r.rest));
  TwoDoubles top = fast_two_sum(p.sin.hi, p.sin.lo);
  TwoDoubles bottom = fast_two_sum(p.cos.hi, p.cos.lo);
  if (std::fmod(r.quarters, 2) != 0) {
    std::swap(top, bottom);
    top = {-top.hi, -top.lo};
  }
  const double quotient = top.hi / bottom.hi;
  const double rest = fused(-quotient, bottom.hi, top.hi) + fused(-quotient, bottom.lo, top.lo);
  return std::isfinite(quotient) ? quotient + rest / bottom.hi : quotient;
}

}  // namespace bandsaw
