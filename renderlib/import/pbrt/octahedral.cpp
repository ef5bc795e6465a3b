// Converts the environment image of a pbrt scene, in which the directions have octahedral
// coordinates or longitude and latitude. The image is looked up in the direction of each pixel of
// our environment map.

#include "renderlib/import/pbrt/octahedral.h"

#include <algorithm>
#include <cmath>

#include "renderlib/import/spectrum/spectrum.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw::pbrt {
namespace {

constexpr std::uint32_t kMaxWidth = 8192;

/// Returns the position of `d` in an image of longitude and latitude around z, in [0, 1]^2.
Vec2 longitude_latitude(const Vec3& d) {
  const double phi = atan2(d.y, d.x);
  return {(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi), acos(d.z) / kPi};
}

/// Returns the pixel at (x, y), which may lie outside of the image. Beyond an edge of the
/// octahedral square, the image continues at the mirrored position on the same edge.
const Rgb& pixel(const Sky& sky, std::int64_t x, std::int64_t y) {
  const auto w = static_cast<std::int64_t>(sky.image.width);
  const auto h = static_cast<std::int64_t>(sky.image.height);
  if (sky.is_octahedral) {
    if (x < 0 || x >= w) {
      x = std::clamp<std::int64_t>(x, 0, w - 1);
      y = h - 1 - y;
    }
    if (y < 0 || y >= h) {
      y = std::clamp<std::int64_t>(y, 0, h - 1);
      x = w - 1 - x;
    }
  }
  x = (x % w + w) % w;
  y = std::clamp<std::int64_t>(y, 0, h - 1);
  return sky.image.pixels[static_cast<std::size_t>(y * w + x)];
}

void add(const Rgb& rgb, double weight, double sum[3]) {
  sum[0] += weight * rgb.r;
  sum[1] += weight * rgb.g;
  sum[2] += weight * rgb.b;
}

/// Adds the radiance in a direction (a unit vector) to `sum`, interpolated bilinearly.
void add_lookup(const Sky& sky, const Vec3& direction, double sum[3]) {
  const Vec2 at = sky.is_octahedral ? octahedral_of(direction) : longitude_latitude(direction);
  const double x = at.x * sky.image.width - 0.5;
  const double y = at.y * sky.image.height - 0.5;
  const auto ix = static_cast<std::int64_t>(std::floor(x));
  const auto iy = static_cast<std::int64_t>(std::floor(y));
  const double fx = x - static_cast<double>(ix);
  const double fy = y - static_cast<double>(iy);
  add(pixel(sky, ix, iy), (1 - fx) * (1 - fy), sum);
  add(pixel(sky, ix + 1, iy), fx * (1 - fy), sum);
  add(pixel(sky, ix, iy + 1), (1 - fx) * fy, sum);
  add(pixel(sky, ix + 1, iy + 1), fx * fy, sum);
}

}  // namespace

// The map of Clarberg 2008. In each quadrant, u + v is r = sqrt(1 - |z|), and v / r is `phi`, the
// angle around z in quarter turns. For z < 0 the point is mirrored at the line u + v = 1.
Vec2 octahedral_of(const Vec3& d) {
  const double x = std::abs(d.x);
  const double y = std::abs(d.y);
  const double r = std::sqrt(std::max(0.0, 1 - std::abs(d.z)));
  const double high = std::max(x, y);
  const double share = high == 0 ? 0 : atan2(std::min(x, y), high) * 2 / kPi;
  const double phi = x < y ? 1 - share : share;
  double v = phi * r;
  double u = r - v;
  if (d.z < 0) {
    const double old_u = u;
    u = 1 - v;
    v = 1 - old_u;
  }
  return {(std::copysign(u, d.x) + 1) / 2, (std::copysign(v, d.y) + 1) / 2};
}

Image equirectangular(const Sky& sky, const Transform& to_light) {
  // In each column of the octahedral square, two pixels lie on the equator. The equator of the
  // result gets as many pixels in total.
  const std::uint32_t width = std::clamp<std::uint32_t>(
      sky.is_octahedral ? 2 * sky.image.width : sky.image.width, 8, kMaxWidth);
  Image out;
  out.width = width;
  out.height = width / 2;
  out.pixels.resize(std::size_t{out.width} * out.height);
  for (std::uint32_t y = 0; y < out.height; ++y) {
    for (std::uint32_t x = 0; x < out.width; ++x) {
      double sum[3] = {};
      for (const double dy : {0.25, 0.75}) {
        for (const double dx : {0.25, 0.75}) {
          // The centre of the image is +x, the centre of its right half is +z, its top row is +y.
          const SinCos down = sincos_turns((y + dy) / out.height / 2);
          const SinCos around = sincos_turns((x + dx) / out.width - 0.5);
          const Vec3 world{down.sin * around.cos, down.cos, down.sin * around.sin};
          add_lookup(sky, normalize(to_light.direction(world)), sum);
        }
      }
      out.pixels[std::size_t{y} * out.width + x] = {static_cast<float>(sum[0] / 4),
                                                    static_cast<float>(sum[1] / 4),
                                                    static_cast<float>(sum[2] / 4)};
    }
  }
  return out;
}

double illuminance_of(const Sky& sky) {
  constexpr int kRings = 256;
  constexpr int kPerRing = 512;
  double total = 0;
  for (int i = 0; i < kRings; ++i) {
    // The density of the directions is proportional to the cosine, so all have the same weight.
    const double cosine = std::sqrt((i + 0.5) / kRings);
    const double sine = std::sqrt(1 - cosine * cosine);
    for (int k = 0; k < kPerRing; ++k) {
      const SinCos around = sincos_turns((k + 0.5) / kPerRing);
      double sum[3] = {};
      add_lookup(sky, {sine * around.cos, sine * around.sin, cosine}, sum);
      total += spectrum::luminance({sum[0], sum[1], sum[2]});
    }
  }
  return std::max(total * kPi / (kRings * kPerRing), 1e-12);
}

}  // namespace bandsaw::pbrt
