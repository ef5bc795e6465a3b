// Converts between linear RGB, XYZ relative to white, the opponent colour space of FLIP, and CIE
// L*a*b*.

#include "renderlib/compare/perceived.h"

#include <algorithm>

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

float clamped(float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; }

// sRGB's primaries in XYZ (IEC 61966-2-1), as ratios of integers.
constexpr double kToXyz[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}};

double row_sum(int row) { return kToXyz[row][0] + kToXyz[row][1] + kToXyz[row][2]; }

// Returns the function f of CIE 1976 L*a*b*.
double cube_root_part(double t) {
  constexpr double kKnee = 6.0 / 29;
  return t > kKnee * kKnee * kKnee ? pow(t, 1.0 / 3) : t / (3 * kKnee * kKnee) + 4.0 / 29;
}

}  // namespace

Rgb clamped(const Rgb& linear) { return {clamped(linear.r), clamped(linear.g), clamped(linear.b)}; }

Vec3 xyz_over_white(const Rgb& linear) {
  double out[3];
  for (int i = 0; i < 3; ++i) {
    out[i] =
        (kToXyz[i][0] * linear.r + kToXyz[i][1] * linear.g + kToXyz[i][2] * linear.b) / row_sum(i);
  }
  return {out[0], out[1], out[2]};
}

Vec3 linear_of(const Vec3& over_white) {
  // Solves kToXyz * linear = xyz by Cramer's rule.
  const Vec3 a{kToXyz[0][0], kToXyz[1][0], kToXyz[2][0]};
  const Vec3 b{kToXyz[0][1], kToXyz[1][1], kToXyz[2][1]};
  const Vec3 c{kToXyz[0][2], kToXyz[1][2], kToXyz[2][2]};
  const Vec3 xyz{over_white.x * row_sum(0), over_white.y * row_sum(1), over_white.z * row_sum(2)};
  const double volume = dot(a, cross(b, c));
  return {dot(xyz, cross(b, c)) / volume, dot(xyz, cross(c, a)) / volume,
          dot(xyz, cross(a, b)) / volume};
}

Vec3 opponents(const Vec3& xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Vec3 xyz_of_opponents(const Vec3& opponents) {
  const double y = (opponents.x + 16) / 116;
  return {y + opponents.y / 500, y, y - opponents.z / 200};
}

Vec3 lab(const Vec3& xyz) {
  const double x = cube_root_part(xyz.x);
  const double y = cube_root_part(xyz.y);
  const double z = cube_root_part(xyz.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

}  // namespace bandsaw
