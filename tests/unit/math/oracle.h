#pragma once

// Reference values for elementary_test.cpp: elementary functions with more precision than double.
// With g++ on x86-64 the functions come from libquadmath. Elsewhere they come from the C library
// and use long double, which has 80 bits with clang on x86-64 and 128 bits on ARM64.

#include <cmath>

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
#include <quadmath.h>
#endif

namespace bandsaw::test {

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__)
__extension__ using Quad = __float128;
inline Quad pi() { return 4 * atanq(1); }
inline Quad quad_sin(Quad x) { return sinq(x); }
inline Quad quad_cos(Quad x) { return cosq(x); }
inline Quad quad_tan(Quad x) { return tanq(x); }
inline Quad quad_asin(Quad x) { return asinq(x); }
inline Quad quad_acos(Quad x) { return acosq(x); }
inline Quad quad_atan2(Quad y, Quad x) { return atan2q(y, x); }
inline Quad quad_exp(Quad x) { return expq(x); }
inline Quad quad_expm1(Quad x) { return expm1q(x); }
inline Quad quad_log(Quad x) { return logq(x); }
inline Quad quad_log1p(Quad x) { return log1pq(x); }
inline Quad quad_pow(Quad x, Quad y) { return powq(x, y); }
inline Quad quad_sqrt(Quad x) { return sqrtq(x); }
#else
using Quad = long double;
inline Quad pi() { return 4 * std::atan(Quad{1}); }
inline Quad quad_sin(Quad x) { return std::sin(x); }
inline Quad quad_cos(Quad x) { return std::cos(x); }
inline Quad quad_tan(Quad x) { return std::tan(x); }
inline Quad quad_asin(Quad x) { return std::asin(x); }
inline Quad quad_acos(Quad x) { return std::acos(x); }
inline Quad quad_atan2(Quad y, Quad x) { return std::atan2(y, x); }
inline Quad quad_exp(Quad x) { return std::exp(x); }
inline Quad quad_expm1(Quad x) { return std::expm1(x); }
inline Quad quad_log(Quad x) { return std::log(x); }
inline Quad quad_log1p(Quad x) { return std::log1p(x); }
inline Quad quad_pow(Quad x, Quad y) { return std::pow(x, y); }
inline Quad quad_sqrt(Quad x) { return std::sqrt(x); }
#endif

inline Quad quad_abs(Quad x) { return x < 0 ? -x : x; }

/// Returns |value - truth| in units in the last place (ulp) of the truth.
inline double error_in_ulps(double value, Quad truth) {
  const double size = std::abs(static_cast<double>(truth));
  const double unit = std::nextafter(size, INFINITY) - size;
  return static_cast<double>(quad_abs(static_cast<Quad>(value) - truth) / unit);
}

}  // namespace bandsaw::test
