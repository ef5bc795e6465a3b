// The height of a point is a sum of octaves of gradient noise; height, latitude and a map of rain
// determine its colour.

#include "renderlib/gallery/globe.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/noise.h"

namespace bandsaw::gallery {
namespace {

/// Colours as sRGB codes.
constexpr Vec3 kDeepSea{10, 34, 82};
constexpr Vec3 kOpenSea{18, 62, 124};
constexpr Vec3 kShelf{58, 142, 172};
constexpr Vec3 kJungle{40, 92, 42};
constexpr Vec3 kMeadow{104, 134, 66};
constexpr Vec3 kDesert{206, 178, 122};
constexpr Vec3 kTundra{142, 134, 112};
constexpr Vec3 kRock{112, 98, 86};
constexpr Vec3 kIce{240, 244, 248};

/// These offsets are added to the points at which noise is evaluated, so that no lattice point of
/// the noise lies at a pole.
constexpr Vec3 kLandAt{11.3, 4.7, 8.1};
constexpr Vec3 kRainAt{-5.2, 9.4, 2.6};
constexpr double kContinents = 1.35;  // frequency of the coarsest octave: features per radius
constexpr double kSeaLevel = 0.06;
constexpr double kShelfDepth = 0.075;

/// Returns 0 below `from`, 1 above `to`, and a smooth transition between them.
double rise(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Returns the number of octaves whose features are at least as large as two texels at the equator.
int octaves_of(std::uint32_t rows) {
  int octaves = 1;
  for (double rate = 2 * kContinents; rate <= rows / (2 * kPi); rate *= 2) {
    ++octaves;
  }
  return octaves;
}

/// Returns the sum of noise(2^i p) / 2^i over the octaves first <= i < last.
double fractal(const Vec3& p, int first, int last) {
  double sum = 0;
  double scale = static_cast<double>(1 << first);
  for (int i = first; i < last; ++i, scale *= 2) {
    sum += noise(p * scale) / scale;
  }
  return sum;
}

/// Returns the colour of the sea. `broad` is the height without its finer octaves. It gives the
/// colour of the open sea, whose floor is smooth.
Vec3 sea(double height, double broad) {
  const Vec3 open = lerp(kDeepSea, kOpenSea, rise(-0.55, -0.1, broad));
  return lerp(open, kShelf, rise(-kShelfDepth, 0, height));
}

/// Returns the colour of land. `latitude` is the absolute value of the sine of the latitude.
Vec3 land(double height, double rain, double latitude) {
  const double dry = rise(0.02, 0.3, 0.32 - 1.6 * std::abs(latitude - 0.32) - 1.3 * rain);
  const double cold = rise(0.68, 0.84, latitude + 0.25 * height - 0.12 * rain);
  Vec3 color = lerp(kJungle, kMeadow, rise(0.12, 0.42, latitude + 0.3 * rain));
  color = lerp(color, kDesert, dry);
  color = lerp(color, kTundra, cold);
  color = lerp(color, kRock, rise(0.22, 0.42, height));
  return lerp(color, kIce, rise(0.44, 0.56, height + 0.2 * latitude));
}

/// Returns the colour of a point on the unit sphere without polar ice. In the deep sea the finer
/// octaves change nothing and are not computed. This saves time, because most of the planet is sea.
Vec3 uncovered(const Vec3& p, double latitude, double rain, int octaves) {
  constexpr int kBroad = 4;  // number of coarse octaves
  // Bound of the sum of the finer octaves: noise is at most 0.87.
  constexpr double kMaxFine = 2 * 0.87 / (1 << kBroad);
  const Vec3 at = p * kContinents + kLandAt;
  const double broad = fractal(at, 0, kBroad) - kSeaLevel;
  if (broad + kMaxFine < -kShelfDepth) {
    return sea(-kShelfDepth, broad);
  }
  const double height = broad + fractal(at, kBroad, octaves);
  return height < 0 ? sea(height, broad) : land(height, rain, latitude);
}

/// Returns the colour of the point `p` on the unit sphere.
Vec3 color_at(const Vec3& p, int octaves) {
  const double latitude = std::abs(p.y);  // as a sine: 0 at the equator, 1 at the poles
  const double rain = fractal(p * 2.3 + kRainAt, 0, 3);
  const double ice = rise(0.93, 0.955, latitude + 0.08 * rain);
  return ice == 1 ? kIce : lerp(uncovered(p, latitude, rain, octaves), kIce, ice);
}

/// Rounds a colour value in [0, 255] to an sRGB code.
std::uint8_t code(double value) { return static_cast<std::uint8_t>(value + 0.5); }

}  // namespace

std::vector<std::uint8_t> globe_map(std::uint32_t rows, Pool& pool) {
  const std::uint32_t columns = 2 * rows;
  const int octaves = octaves_of(rows);
  std::vector<Vec2> meridians;  // cosine and sine of each column's longitude
  for (std::uint32_t x = 0; x < columns; ++x) {
    const SinCos longitude = sincos_turns((x + 0.5) / columns);
    meridians.push_back({longitude.cos, longitude.sin});
  }
  std::vector<std::uint8_t> codes(std::size_t{columns} * rows * 3);
  pool.parallel_for(rows, [&](std::int64_t row) {
    const SinCos from_north = sincos_turns((static_cast<double>(row) + 0.5) / columns);
    std::uint8_t* out = &codes[static_cast<std::size_t>(row) * columns * 3];
    for (const Vec2& meridian : meridians) {
      const Vec3 p{from_north.sin * meridian.x, from_north.cos, from_north.sin * meridian.y};
      const Vec3 color = color_at(p, octaves);
      *out++ = code(color.x);
      *out++ = code(color.y);
      *out++ = code(color.z);
    }
  });
  return codes;
}

}  // namespace bandsaw::gallery
