// Computes the colours of the sky from a direction, and draws them into an environment map of one
// or six images.

#include "renderlib/gallery/sky.h"

#include <algorithm>
#include <cmath>

#include "renderlib/light/environment.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/noise.h"

namespace bandsaw::gallery {
namespace {

/// The layout of an environment map, without texels: one image of the given size, or six for a
/// cube. direction_of() needs it to convert a position in an image to a direction.
struct EnvironmentLayout {
  EnvironmentLayout(Environment::Kind kind, std::uint32_t width, std::uint32_t height) {
    ImageTexture image;
    image.width = width;
    image.height = height;
    environment.kind = kind;
    const std::uint32_t count = kind == Environment::Kind::kCube ? 6 : 1;
    for (std::uint32_t i = 0; i < count; ++i) {
      textures.emplace_back(image);
      environment.images.push_back(TextureId{i});
    }
  }
  std::vector<Texture> textures;
  Environment environment;
};

/// Draws one image of an environment (`face` 0 to 5 of a cube, otherwise 0). A texel is the mean of
/// `sky` in kFine x kFine directions.
Image draw(Rgb (*sky)(const Vec3&), const EnvironmentLayout& layout, std::uint32_t face,
           std::uint32_t width, std::uint32_t height) {
  constexpr int kFine = 8;
  Image image{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      Rgb sum;
      for (int i = 0; i < kFine * kFine; ++i) {
        const EnvironmentPlace place{face, x + (i % kFine + 0.5) / kFine,
                                     y + (i / kFine + 0.5) / kFine};
        sum += sky(direction_of(layout.environment, layout.textures, place));
      }
      image.pixels.push_back(sum * (1.0f / (kFine * kFine)));
    }
  }
  return image;
}

constexpr double kSunAzimuth = 40;  // degrees

/// Returns a unit direction. Its azimuth is measured from +x towards +z, its height from the
/// horizon.
Vec3 direction(double azimuth_degrees, double height_degrees) {
  const SinCos azimuth = sincos_degrees(azimuth_degrees);
  const SinCos height = sincos_degrees(height_degrees);
  return {height.cos * azimuth.cos, height.sin, height.cos * azimuth.sin};
}

/// Returns the amount of cloud in a direction above the horizon, in [0, 0.85]. It is the turbulence
/// at the point where the direction meets a layer of clouds, which are stretched along x. `from` is
/// subtracted from the turbulence: the larger `from`, the less cloud.
float cover(const Vec3& unit, double from) {
  const double layer = 1 / (unit.y + 0.12);
  const double cloud =
      turbulence({unit.x * layer * 0.7, 3.5, unit.z * layer * 1.6}, 6) * std::min(1.0, 6 * unit.y);
  return static_cast<float>(std::clamp(3 * cloud - from, 0.0, 0.85));
}

Image equirectangular(Rgb (*sky)(const Vec3&), std::uint32_t rows) {
  return draw(sky, EnvironmentLayout(Environment::Kind::kEquirectangular, 2 * rows, rows), 0,
              2 * rows, rows);
}

}  // namespace

Rgb evening_sky(const Vec3& unit) {
  const double towards = dot(unit, direction(kSunAzimuth, 25));  // cosine of the angle to the sun
  if (towards > sincos_degrees(3).cos) {
    return {300, 225, 140};
  }
  if (unit.y < 0) {
    const auto share = static_cast<float>(std::min(1.0, -8 * unit.y));
    return lerp(Rgb{0.5f, 0.33f, 0.2f}, Rgb{0.12f, 0.1f, 0.08f}, share);
  }
  const auto up = static_cast<float>(std::sqrt(unit.y));
  const Rgb air = lerp(Rgb{1.1f, 0.55f, 0.25f}, Rgb{0.12f, 0.25f, 0.6f}, up);
  const Rgb glow = Rgb{1.6f, 0.9f, 0.4f} * static_cast<float>(pow(std::max(0.0, towards), 24));
  return lerp(air + glow, Rgb{0.95f, 0.7f, 0.6f} + glow, cover(unit, 0.55));
}

Rgb dusk_sky(const Vec3& unit) {
  // `side` is 1 at the azimuth of sunset and 0 opposite.
  const double flat = std::sqrt(unit.x * unit.x + unit.z * unit.z);
  const double side =
      flat > 0 ? (1 + dot({unit.x, 0, unit.z}, direction(kSunAzimuth, 0)) / flat) / 2 : 0.5;
  const auto warm = static_cast<float>(side * side * side);
  const Rgb horizon = lerp(Rgb{0.10f, 0.14f, 0.26f}, Rgb{2.4f, 0.85f, 0.22f}, warm);
  if (unit.y < 0) {
    return horizon * 0.12f;
  }
  const Rgb middle = lerp(Rgb{0.06f, 0.11f, 0.25f}, Rgb{0.45f, 0.24f, 0.30f}, warm);
  const auto low = static_cast<float>(std::max(0.0, 1 - unit.y / 0.16));
  const auto high = static_cast<float>(std::min(1.0, unit.y / 0.6));
  const Rgb air = lerp(lerp(middle, Rgb{0.02f, 0.045f, 0.13f}, high), horizon, low * low);
  const Rgb cloud = lerp(Rgb{0.05f, 0.07f, 0.15f}, Rgb{1.1f, 0.42f, 0.28f}, warm);
  // A high cloud that the sun still lights: a soft light from the side.
  const double bank = std::max(0.0, dot(unit, direction(kSunAzimuth - 88, 42)));
  const Rgb lit = Rgb{5.0f, 3.9f, 2.9f} * static_cast<float>(pow(bank, 10));
  return lit + lerp(air, cloud, 0.8f * cover(unit, 0.75));
}

Image evening_sky_map(std::uint32_t rows) { return equirectangular(evening_sky, rows); }
Image dusk_sky_map(std::uint32_t rows) { return equirectangular(dusk_sky, rows); }

Image evening_sky_side(std::uint32_t face, std::uint32_t side) {
  return draw(evening_sky, EnvironmentLayout(Environment::Kind::kCube, side, side), face, side,
              side);
}

}  // namespace bandsaw::gallery
