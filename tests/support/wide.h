#pragma once

// Numbers with 113 bits of mantissa, for reference results of geometry. Their rounding errors are
// so much smaller than those of double that a test takes a result as exact.

#include <cmath>

#include "renderlib/math/vec.h"

namespace bandsaw::test {

#if defined(__aarch64__)
using Wide = long double;  // has 113 bits on ARM64, but only 64 on x86-64
#else
__extension__ using Wide = __float128;
#endif

/// Refines double's square root by two steps of Newton's method; returns 0 if x is not positive.
inline Wide wide_sqrt(Wide x) {
  if (!(x > 0)) {
    return 0;
  }
  Wide root = std::sqrt(static_cast<double>(x));
  root = (root + x / root) / 2;
  return (root + x / root) / 2;
}

struct WideVec {
  Wide x;
  Wide y;
  Wide z;
  WideVec(Wide a, Wide b, Wide c) : x(a), y(b), z(c) {}
  WideVec(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT: implicit, as from double
};
inline WideVec operator+(const WideVec& a, const WideVec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline WideVec operator-(const WideVec& a, const WideVec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline WideVec operator*(const WideVec& a, Wide s) { return {a.x * s, a.y * s, a.z * s}; }
inline Wide dot(const WideVec& a, const WideVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline WideVec cross(const WideVec& a, const WideVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Wide length(const WideVec& a) { return wide_sqrt(dot(a, a)); }

}  // namespace bandsaw::test
