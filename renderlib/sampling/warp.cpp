// Maps from the unit square to disk, hemisphere, sphere, ball and cone. Where the quadrant is
// random, branches are avoided, because they would be mispredicted.

#include "renderlib/sampling/warp.h"

#include <bit>
#include <cstdint>

#include "renderlib/math/elementary.h"
#include "renderlib/math/polynomial.h"

namespace bandsaw {
namespace {

/// Returns sine and cosine of x pi / 4 for x in [-1, 1] to a few units in the last place, by Taylor
/// series. This takes a third of the time of `sincos_turns`, which is more accurate.
SinCos sincos_eighths(double x) {
  static constexpr double kSin[] = {
      0x1.921fb54442d18p-1,  -0x1.4abbce625be53p-4,  0x1.466bc6775aae2p-9,  -0x1.32d2cce62bd86p-15,
      0x1.50783487ee782p-22, -0x1.e3074fde8871fp-30, 0x1.e8f434d018d63p-38, -0x1.6fadb9f155744p-46};
  static constexpr double kCos[] = {1,
                                    -0x1.3bd3cc9be45dep-2,
                                    0x1.03c1f081b5ac4p-6,
                                    -0x1.55d3c7e3cbffap-12,
                                    0x1.e1f506891babbp-19,
                                    -0x1.a6d1f2a204a8cp-26,
                                    0x1.f9d38a3763cc3p-34,
                                    -0x1.b6e24f44b128fp-42,
                                    0x1.20c62c2f2d7f5p-50};
  const double square = x * x;
  return {x * polynomial(square, kSin), polynomial(square, kCos)};
}

/// Returns (y, x) if all bits of `mask` are set, (x, y) if none is, without a branch.
Vec2 swapped(const Vec2& v, std::uint64_t mask) {
  const auto x = std::bit_cast<std::uint64_t>(v.x);
  const auto y = std::bit_cast<std::uint64_t>(v.y);
  const std::uint64_t change = (x ^ y) & mask;
  return {std::bit_cast<double>(x ^ change), std::bit_cast<double>(y ^ change)};
}

/// Returns the point of the unit circle at the angle of `turn` turns, in [0, 1]. The quadrant is
/// unpredictable, so there is no branch.
Vec2 on_circle(double turn) {
  const double quarters = std::floor(4 * turn + 0.5);
  const SinCos angle = sincos_eighths(2 * (4 * turn - quarters));
  const auto quarter = static_cast<std::uint64_t>(quarters);
  const Vec2 at = swapped({angle.cos, angle.sin}, -(quarter & 1));
  // Bit 63 is the sign. Flips x in quarters 1 and 2, and y in quarters 2 and 3.
  return {std::bit_cast<double>(std::bit_cast<std::uint64_t>(at.x) ^ ((quarter + 1) & 2) << 62),
          std::bit_cast<double>(std::bit_cast<std::uint64_t>(at.y) ^ (quarter & 2) << 62)};
}

}  // namespace

Vec2 sample_disk(double u, double v) {
  const double a = 2 * u - 1;
  const double b = 2 * v - 1;
  if (a == 0 && b == 0) {
    return {0, 0};
  }
  // The angle is (pi / 4) (b / a) or pi / 2 - (pi / 4) (a / b). The choice between the two is
  // unpredictable, so there is no branch.
  const std::uint64_t swap = std::abs(a) > std::abs(b) ? 0 : ~std::uint64_t{0};
  const Vec2 ordered = swapped({a, b}, swap);
  const SinCos angle = sincos_eighths(ordered.y / ordered.x);
  return swapped({ordered.x * angle.cos, ordered.x * angle.sin}, swap);
}

Vec3 sample_cosine_hemisphere(double u, double v) {
  const Vec2 d = sample_disk(u, v);
  // On the rim, rounding could make z 0. The minimum prevents this, because a direction of pdf 0
  // must not be sampled.
  constexpr double kMinSquare = 0x1p-64;
  const double z = std::sqrt(std::max(kMinSquare, 1 - d.x * d.x - d.y * d.y));
  return {d.x, d.y, z};
}

Vec3 sample_sphere(double u, double v) { return sample_cone(u, v, 2); }

Vec3 sample_ball(double u, double v, double w) { return sample_sphere(u, v) * pow(w, 1.0 / 3); }

Vec3 sample_cone(double u, double v, double one_minus_cos) {
  const double h = u * one_minus_cos;  // 1 - cos theta
  const double sin_theta = std::sqrt(std::max(0.0, h * (2 - h)));
  const Vec2 around = on_circle(v);
  return {sin_theta * around.x, sin_theta * around.y, 1 - h};
}

}  // namespace bandsaw
