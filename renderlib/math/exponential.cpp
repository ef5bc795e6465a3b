#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/fused.h"
#include "renderlib/math/polynomial.h"

// exp() and expm1() write x as k log 2 + r with |r| <= log(2) / 2, and evaluate the Taylor series
// of exp(r) - 1. log() and log1p() write their argument as 2^k m with m in [sqrt(1/2), sqrt(2)).
// With s = (m - 1) / (m + 1), log m is 2 s + 2 s^3 / 3 + 2 s^5 / 5 + … pow() is exp(y log x), in
// which log x is a sum of two doubles.

namespace bandsaw {
namespace {

constexpr double kLog2E = 0x1.71547652b82fep+0;
/// log 2; hi has 21 zero bits at its end, so that k hi is exact.
constexpr TwoDoubles kLog2 = {0x1.62e42fee00000p-1, 0x1.a39ef35793c76p-33};
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Returns 2^k for k in [-1022, 1023].
double power_of_two(int k) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// Returns a 2^k for k in [-2044, 2046], in two steps that are each in range.
double scale_by_power(double a, int k) {
  const int half = k / 2;
  return a * power_of_two(half) * power_of_two(k - half);
}

/// Returns exp(r) - 1 for |r| <= 0.36, r = hi + lo.
TwoDoubles expm1_reduced(double hi, double lo) {
  static constexpr double kExp[] = {
      1.0 / 2,         1.0 / 6,          1.0 / 24,         1.0 / 120,     1.0 / 720,
      1.0 / 5040,      1.0 / 40320,      1.0 / 362880,     1.0 / 3628800, 1.0 / 39916800,
      1.0 / 479001600, 1.0 / 6227020800, 1.0 / 87178291200};
  const double rest = hi * hi * polynomial(hi, kExp);
  const TwoDoubles sum = fast_two_sum(hi, rest);
  return {sum.hi, sum.lo + fused(hi + rest, lo, lo)};
}

/// x as k log 2 + (hi + lo), where |hi + lo| <= log(2) / 2 up to rounding.
struct ReducedExp {
  double k;  // an integer
  double hi;
  double lo;
};

/// Reduces the argument x of exp() or expm1(); |x| < 1100.
ReducedExp reduce_exp(double x) {
  const double k = std::nearbyint(x * kLog2E);
  const TwoDoubles r = two_sum(x - k * kLog2.hi, -k * kLog2.lo);
  return {k, r.hi, r.lo};
}

/// Returns log(1 + f) - f for 1 + f in [sqrt(1/2), sqrt(2)].
double log_rest(double f) {
  static constexpr double kLog[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13,
                                    2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23, 2.0 / 25};
  const double s = f / (2 + f);
  const double square = s * s;
  const double half = 0.5 * f * f;
  // log(1 + f) = f - f^2 / 2 + s (f^2 / 2 + s^2 (2/3 + …)).
  return fused(s, fused(square, polynomial(square, kLog), half), -half);
}

struct Normalised {
  int k;
  double m;  // in [sqrt(1/2), sqrt(2))
};

/// Splits x (> 0, finite) into 2^k m.
Normalised normalise(double x) {
  int k = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    k = -54;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  k += static_cast<int>(bits >> 52) - 1022;
  double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | (std::uint64_t{1022} << 52));
  if (m < 0x1.6a09e667f3bcdp-1) {
    m *= 2;
    --k;
  }
  return {k, m};
}

/// Returns log(2^k (1 + f)) + extra.
TwoDoubles log_parts(int k, double f, double extra) {
  const TwoDoubles head = two_sum(k * kLog2.hi, f);
  const TwoDoubles sum = two_sum(head.hi, log_rest(f));
  return {sum.hi, sum.lo + (head.lo + fused(k, kLog2.lo, extra))};
}

}  // namespace

// The logarithm of the largest double is 709.78…, so exp(x) overflows for x >= 709.8. The logarithm
// of half the smallest positive double is -745.13…, so exp(x) rounds to 0 for x < -745.2.
double exp(double x) {
  if (!(x < 709.8)) {
    return std::isnan(x) ? x : kInfinity;
  }
  if (x < -745.2) {
    return 0;
  }
  const ReducedExp r = reduce_exp(x);
  const TwoDoubles e = expm1_reduced(r.hi, r.lo);
  return scale_by_power(1 + (e.hi + e.lo), static_cast<int>(r.k));
}

double expm1(double x) {
  if (!(x < 709.8)) {
    return std::isnan(x) ? x : kInfinity;
  }
  if (x < -40) {
    return -1;  // exp(-40) < 2^-57 is less than half a unit in the last place of 1.
  }
  const ReducedExp r = reduce_exp(x);
  const TwoDoubles e = expm1_reduced(r.hi, r.lo);
  if (r.k == 0) {
    return e.hi + e.lo;
  }
  if (r.k > 60) {  // The -1 is less than half a unit in the last place.
    return scale_by_power(1 + (e.hi + e.lo), static_cast<int>(r.k));
  }
  const double scale = power_of_two(static_cast<int>(r.k));
  const TwoDoubles head = two_sum(scale - 1, scale * e.hi);
  return head.hi + (head.lo + scale * e.lo);
}

double log(double x) {
  if (!(x > 0) || x == kInfinity) {
    return x == 0 ? -kInfinity : x == kInfinity ? x : kNan;
  }
  const Normalised n = normalise(x);
  const TwoDoubles l = log_parts(n.k, n.m - 1, 0);
  return l.hi + l.lo;
}

double log1p(double x) {
  if (!(x > -1) || x == kInfinity) {
    return x == -1 ? -kInfinity : x == kInfinity ? x : kNan;
  }
  if (-0.25 < x && x < 0.4) {  // in the domain of log_rest()
    return x + log_rest(x);
  }
  const TwoDoubles u = two_sum(1, x);
  const Normalised n = normalise(u.hi);
  const TwoDoubles l = log_parts(n.k, n.m - 1, u.lo / u.hi);
  return l.hi + l.lo;
}

double pow(double x, double y) {
  if (y == 0 || x == 1) {
    return 1;
  }
  if (!(x >= 0) || std::isnan(y)) {
    return kNan;
  }
  if (x == 0 || x == kInfinity || std::isinf(y)) {
    const bool grows = (x > 1) == (y > 0);
    return grows ? kInfinity : 0;
  }
  const Normalised n = normalise(x);
  const TwoDoubles l = log_parts(n.k, n.m - 1, 0);
  const TwoDoubles product = two_product(y, l.hi);
  if (!(std::abs(product.hi) < 800)) {  // exp() overflows or underflows.
    return product.hi > 0 ? kInfinity : 0;
  }
  const double power = exp(product.hi);
  const double correction = fused(y, l.lo, product.lo);
  return power == kInfinity ? power : fused(power, correction, power);
}

}  // namespace bandsaw
