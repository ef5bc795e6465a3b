// Converts between directions and texels, for equirectangular maps and for cube maps, and
// interpolates between four texels.

#include "renderlib/light/environment.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/blend.h"
#include "renderlib/texture/image_texture.h"

namespace bandsaw {
namespace {

const ImageTexture& image_of(const Environment& environment, absl::Span<const Texture> textures,
                             std::uint32_t image) {
  return std::get<ImageTexture>(textures[index_of(environment.images[image])]);
}

/// Orientation of a cube map's image: the directions to its centre, its right edge and its top
/// edge.
struct Face {
  Vec3 middle;
  Vec3 right;
  Vec3 up;
};
/// The faces in the order of Environment::images (OpenGL 4.6 specification, table 8.19).
constexpr std::array<Face, 6> kFaces = {{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
                                         {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                         {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
                                         {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
                                         {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                         {{0, 0, -1}, {-1, 0, 0}, {0, 1, 0}}}};

/// Returns the position of the direction `d` in the images of a cube map, whose faces are `side`
/// texels wide. `d` is given in the axes of the map.
EnvironmentPlace place_on_cube(const Vec3& d, double side) {
  std::uint32_t image = 0;
  for (std::uint32_t i = 1; i < kFaces.size(); ++i) {
    image = dot(d, kFaces[i].middle) > dot(d, kFaces[image].middle) ? i : image;
  }
  const Face& face = kFaces[image];
  const double ahead = dot(d, face.middle);
  const double s = dot(d, face.right) / ahead;
  const double t = dot(d, face.up) / ahead;
  return {image, 0.5 * (1 + s) * side, 0.5 * (1 - t) * side};
}

/// Returns the position of the direction `d`, in the axes of the map, in an equirectangular image.
EnvironmentPlace place_on_sphere(const Vec3& d, const ImageTexture& image) {
  const double around = atan2(d.z, d.x) * (0.5 * kInvPi) + 0.5;
  const double down = atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) * kInvPi;
  return {0, around * image.width, down * image.height};
}

}  // namespace

EnvironmentPlace place_of(const Environment& environment, absl::Span<const Texture> textures,
                          const Vec3& unit_direction) {
  const Vec3 d = environment.axes.to_local(unit_direction);
  const ImageTexture& image = image_of(environment, textures, 0);
  return environment.kind == Environment::Kind::kCube ? place_on_cube(d, image.width)
                                                      : place_on_sphere(d, image);
}

Vec3 direction_of(const Environment& environment, absl::Span<const Texture> textures,
                  const EnvironmentPlace& place) {
  const ImageTexture& image = image_of(environment, textures, place.image);
  if (environment.kind == Environment::Kind::kCube) {
    const Face& face = kFaces[place.image];
    const Vec3 d = face.middle + face.right * (2 * place.x / image.width - 1) +
                   face.up * (1 - 2 * place.y / image.height);
    return normalize(environment.axes.to_world(d));
  }
  const SinCos around = sincos_turns(place.x / image.width - 0.5);
  const SinCos down = sincos_turns(0.5 * place.y / image.height);
  return normalize(
      environment.axes.to_world({down.sin * around.cos, down.cos, down.sin * around.sin}));
}

FourTexels texels_around(const Environment& environment, const ImageTexture& image,
                         const EnvironmentPlace& place) {
  const double x = std::floor(place.x - 0.5);
  const double y = std::floor(place.y - 0.5);
  const bool wraps = environment.kind == Environment::Kind::kEquirectangular;
  const auto column = [&](double i) {
    const double last = image.width - 1.0;
    const double wrapped = i < 0 ? last : i > last ? 0 : i;
    return static_cast<std::uint32_t>(wraps ? wrapped : std::clamp(i, 0.0, last));
  };
  const auto row = [&](double i) {
    return static_cast<std::uint32_t>(std::clamp(i, 0.0, image.height - 1.0));
  };
  return {column(x), column(x + 1), row(y), row(y + 1), place.x - 0.5 - x, place.y - 0.5 - y};
}

Rgb radiance(const Environment& environment, absl::Span<const Texture> textures,
             const Vec3& unit_direction) {
  const EnvironmentPlace place = place_of(environment, textures, unit_direction);
  const ImageTexture& image = image_of(environment, textures, place.image);
  const FourTexels four = texels_around(environment, image, place);
  const auto fx = static_cast<float>(four.fx);
  const Rgb upper =
      blend(texel(image, four.left, four.top), texel(image, four.right, four.top), fx);
  const Rgb lower =
      blend(texel(image, four.left, four.bottom), texel(image, four.right, four.bottom), fx);
  return blend(upper, lower, static_cast<float>(four.fy)) * environment.strength;
}

}  // namespace bandsaw
