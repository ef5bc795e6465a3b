#include "renderlib/gallery/sky.h"

#include <algorithm>
#include <cmath>

#include "renderlib/light/environment.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/noise.h"

namespace bandsaw::gallery {
namespace {

/// An environment of one image of that size, or of six: it knows where its texels lie.
struct Frame {
  Frame(Environment::Kind kind, std::uint32_t width, std::uint32_t height) {
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

Image draw(const Frame& frame, std::uint32_t face, std::uint32_t width, std::uint32_t height) {
  constexpr int kFine = 8;
  Image image{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      Rgb sum;
      for (int i = 0; i < kFine * kFine; ++i) {
        const EnvironmentPlace place{face, x + (i % kFine + 0.5) / kFine,
                                     y + (i / kFine + 0.5) / kFine};
        sum += evening_sky(direction_of(frame.environment, frame.textures, place));
      }
      image.pixels.push_back(sum * (1.0f / (kFine * kFine)));
    }
  }
  return image;
}

}  // namespace

Rgb evening_sky(const Vec3& unit) {
  const SinCos azimuth = sincos_degrees(40);
  const SinCos height = sincos_degrees(25);
  const Vec3 sun{height.cos * azimuth.cos, height.sin, height.cos * azimuth.sin};
  const double towards = dot(unit, sun);
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
  // Clouds in a layer above: where a direction meets it, drawn out along x.
  const double layer = 1 / (unit.y + 0.12);
  const double cloud =
      turbulence({unit.x * layer * 0.7, 3.5, unit.z * layer * 1.6}, 6) * std::min(1.0, 6 * unit.y);
  const auto cover = static_cast<float>(std::clamp(3 * cloud - 0.55, 0.0, 0.85));
  return lerp(air + glow, Rgb{0.95f, 0.7f, 0.6f} + glow, cover);
}

Image evening_sky_map(std::uint32_t rows) {
  return draw(Frame(Environment::Kind::kEquirectangular, 2 * rows, rows), 0, 2 * rows, rows);
}

Image evening_sky_side(std::uint32_t face, std::uint32_t side) {
  return draw(Frame(Environment::Kind::kCube, side, side), face, side, side);
}

}  // namespace bandsaw::gallery
