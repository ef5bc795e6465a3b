#include "renderlib/light/light_cone.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Larger than the rounding error of the angles in one merge.
constexpr double kSlack = 1e-9;

SinCos sincos(double radians) { return sincos_turns(radians * (0.5 * kInvPi)); }

/// Returns the angle between unit vectors, without loss of precision near 0 and pi.
double angle_between(const Vec3& a, const Vec3& b) {
  return 2 * atan2(length(a - b), length(a + b));
}

}  // namespace

LightCone cone_of(const LightBound& bound) {
  return {bound.axis, acos(bound.cos_spread), acos(bound.cos_reach), bound.two_sided};
}

LightCone merged(const LightCone& a, const LightCone& b) {
  LightCone wide = a;
  LightCone narrow = b;
  if (wide.spread < narrow.spread) {
    std::swap(wide, narrow);
  }
  wide.reach = std::max(a.reach, b.reach);
  wide.two_sided = a.two_sided || b.two_sided;
  if (wide.two_sided && dot(wide.axis, narrow.axis) < 0) {
    narrow.axis = -narrow.axis;  // The cone around the opposite axis is the same.
  }
  const double between = angle_between(wide.axis, narrow.axis);
  if (std::min(between + narrow.spread, kPi) <= wide.spread) {
    return wide;
  }
  const double spread = (wide.spread + between + narrow.spread) / 2 + kSlack;
  const Vec3 across = narrow.axis - wide.axis * dot(narrow.axis, wide.axis);
  if (spread >= kPi || !(length_squared(across) > 0)) {
    wide.spread = kPi;
    return wide;
  }
  // The axis is rotated until the wide cone touches the new one from inside.
  const SinCos turn = sincos(spread - wide.spread);
  wide.axis = normalize(wide.axis * turn.cos + normalize(across) * turn.sin);
  wide.spread = spread;
  return wide;
}

double orientation_measure(const LightCone& cone) {
  const double whole = std::min(cone.spread + cone.reach, kPi);
  const SinCos spread = sincos(cone.spread);
  return 2 * kPi * (1 - spread.cos) +
         0.5 * kPi *
             (2 * whole * spread.sin - sincos(cone.spread - 2 * whole).cos -
              2 * cone.spread * spread.sin + spread.cos);
}

}  // namespace bandsaw
