// Quaternions for rotations. An interpolation follows the shorter way, and angles are computed
// without cancellation.

#include "renderlib/math/quaternion.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Below this angle, in radians, slerp() interpolates linearly: the two sines are nearly zero, and
/// the chord deviates from the arc by less than 1e-17.
constexpr double kMinAngle = 1e-8;

double dot(const Quaternion& a, const Quaternion& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Returns the sum of a times `of_a` and b times `of_b`.
Quaternion mix(const Quaternion& a, double of_a, const Quaternion& b, double of_b) {
  return {a.w * of_a + b.w * of_b, a.x * of_a + b.x * of_b, a.y * of_a + b.y * of_b,
          a.z * of_a + b.z * of_b};
}

double length(const Quaternion& q) { return std::sqrt(dot(q, q)); }

Quaternion unit(const Quaternion& q) { return mix(q, 1 / length(q), {}, 0); }

/// Returns whichever of b and -b is nearer to a; both are the same rotation.
Quaternion nearer(const Quaternion& a, const Quaternion& b) {
  return dot(a, b) < 0 ? mix(b, -1, {}, 0) : b;
}

/// Returns the angle between two quaternions of one hemisphere, in radians, without cancellation
/// near 0 and pi.
double angle(const Quaternion& a, const Quaternion& b) {
  return 2 * bandsaw::atan2(length(mix(a, 1, b, -1)), length(mix(a, 1, b, 1)));
}

}  // namespace

Quaternion quaternion(const Transform& t) {
  const auto& m = t.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  Quaternion q;
  if (trace >= std::max({m[0][0], m[1][1], m[2][2]})) {
    q = {1 + trace, m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
  } else if (m[0][0] >= std::max(m[1][1], m[2][2])) {
    q = {m[2][1] - m[1][2], 1 + m[0][0] - m[1][1] - m[2][2], m[0][1] + m[1][0], m[0][2] + m[2][0]};
  } else if (m[1][1] >= m[2][2]) {
    q = {m[0][2] - m[2][0], m[0][1] + m[1][0], 1 + m[1][1] - m[0][0] - m[2][2], m[1][2] + m[2][1]};
  } else {
    q = {m[1][0] - m[0][1], m[0][2] + m[2][0], m[1][2] + m[2][1], 1 + m[2][2] - m[0][0] - m[1][1]};
  }
  return unit(q);
}

Transform rotation(const Quaternion& q) {
  Transform t;
  t.m[0] = {1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w),
            2 * (q.x * q.z + q.y * q.w), 0};
  t.m[1] = {2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z),
            2 * (q.y * q.z - q.x * q.w), 0};
  t.m[2] = {2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w),
            1 - 2 * (q.x * q.x + q.y * q.y), 0};
  return t;
}

double turn_between(const Quaternion& a, const Quaternion& b) {
  // The rotation turns by twice the angle between the quaternions.
  return angle(a, nearer(a, b)) * kInvPi;
}

Quaternion slerp(const Quaternion& a, const Quaternion& b, double u) {
  const Quaternion to = nearer(a, b);
  const double whole = angle(a, to);
  if (whole < kMinAngle) {
    return unit(mix(a, 1 - u, to, u));
  }
  const double turns = whole * (0.5 * kInvPi);
  return unit(mix(a, sincos_turns(turns * (1 - u)).sin, to, sincos_turns(turns * u).sin));
}

}  // namespace bandsaw
