// The constructor builds a table with a weight for each texel: its luminance above the mean, times
// its solid angle. A sample chooses a texel from the table, then a direction from the texel's
// interpolation kernel.

#include "renderlib/light/environment_light.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "renderlib/math/constants.h"
#include "renderlib/sampling/tent.h"
#include "renderlib/texture/image_texture.h"

namespace bandsaw {
namespace {

/// If the luminance above the mean is less than this share of the total, the environment counts as
/// uniform: the difference is a rounding error or too small to be worth a shadow ray.
constexpr double kMinExcess = 1e-6;

bool is_cube(const Environment& environment) {
  return environment.kind == Environment::Kind::kCube;
}

const ImageTexture& image_of(const Environment& environment, absl::Span<const Texture> textures,
                             std::size_t image) {
  return std::get<ImageTexture>(textures[index_of(environment.images[image])]);
}

double luminance_of(const ImageTexture& image, std::uint32_t x, std::uint32_t y) {
  const Rgb c = texel(image, x, y);
  return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

/// Returns the solid angle per area of a cube map's face at the position (x, y). Position, area and
/// `side`, the width of the face, are in texels.
double cube_solid_angle(double x, double y, double side) {
  const double s = 2 * x / side - 1;
  const double t = 2 * y / side - 1;
  const double distance2 = 1 + s * s + t * t;
  return 4 / (side * side) / (distance2 * std::sqrt(distance2));
}

/// Solid angles of the texels' interpolation kernels (tents). They are exact for a
/// latitude-longitude image, where all texels of a row have the same solid angle. For a cube map
/// the solid angle at the texel's centre is used.
class TexelSolidAngles {
 public:
  TexelSolidAngles(const Environment& environment, const ImageTexture& image) : side_(image.width) {
    if (!is_cube(environment)) {
      for (std::uint32_t row = 0; row < image.height; ++row) {
        rows_.push_back(latitude_tent_solid_angle(row, image.height) / image.width);
      }
    }
  }
  double operator()(std::uint32_t x, std::uint32_t y) const {
    return rows_.empty() ? cube_solid_angle(x + 0.5, y + 0.5, side_) : rows_[y];
  }

 private:
  std::vector<double> rows_;
  double side_;
};

double mean_luminance(const Environment& environment, absl::Span<const Texture> textures,
                      const TexelSolidAngles& solid_angle) {
  double light = 0;
  double all = 0;
  for (std::size_t i = 0; i < environment.images.size(); ++i) {
    const ImageTexture& image = image_of(environment, textures, i);
    for (std::uint32_t y = 0; y < image.height; ++y) {
      for (std::uint32_t x = 0; x < image.width; ++x) {
        light += luminance_of(image, x, y) * solid_angle(x, y);
        all += solid_angle(x, y);
      }
    }
  }
  return light / all;
}

}  // namespace

EnvironmentLight::EnvironmentLight(Environment environment, absl::Span<const Texture> textures)
    : environment_(std::move(environment)), textures_(textures) {
  const ImageTexture& first = image_of(environment_, textures_, 0);
  const TexelSolidAngles solid_angle(environment_, first);
  mean_ = mean_luminance(environment_, textures_, solid_angle);
  const auto rows = static_cast<std::uint32_t>(first.height * environment_.images.size());
  texels_ = GridDistribution(first.width, rows, [&](std::uint32_t x, std::uint32_t row) {
    const std::uint32_t y = row % first.height;
    return weight(image_of(environment_, textures_, row / first.height), x, y) * solid_angle(x, y);
  });
  const double excess = texels_.total() * environment_.strength;
  const bool is_even = texels_.total() <= kMinExcess * 4 * kPi * mean_;
  excess_ = is_even || !std::isfinite(excess) ? 0 : excess;
}

double EnvironmentLight::weight(const ImageTexture& image, std::uint32_t x, std::uint32_t y) const {
  return std::max(0.0, luminance_of(image, x, y) - mean_);
}

double EnvironmentLight::weight_at(const EnvironmentPlace& place) const {
  const ImageTexture& image = image_of(environment_, textures_, place.image);
  const FourTexels four = texels_around(environment_, image, place);
  // On the face of a cube map, the pdf of the tents is by area; it is converted to solid angle.
  const auto of = [&](std::uint32_t x, std::uint32_t y) {
    const double w = weight(image, x, y);
    return is_cube(environment_) && w > 0 ? w * cube_solid_angle(x + 0.5, y + 0.5, image.width) : w;
  };
  const double upper = of(four.left, four.top) * (1 - four.fx) + of(four.right, four.top) * four.fx;
  const double lower =
      of(four.left, four.bottom) * (1 - four.fx) + of(four.right, four.bottom) * four.fx;
  const double sum = upper * (1 - four.fy) + lower * four.fy;
  return is_cube(environment_) ? sum / cube_solid_angle(place.x, place.y, image.width) : sum;
}

EnvironmentLight::Sample EnvironmentLight::sample(double u, double v) const {
  const GridDistribution::Cell cell = texels_.sample(u, v);
  const ImageTexture& first = image_of(environment_, textures_, 0);
  EnvironmentPlace place{cell.row / first.height, 0, 0};
  const std::uint32_t row = cell.row % first.height;
  if (is_cube(environment_)) {
    place.x = sample_tent(cell.column, first.width, Ends::kClamped, cell.u);
    place.y = sample_tent(row, first.height, Ends::kClamped, cell.v);
  } else {
    place.x = sample_tent(cell.column, first.width, Ends::kWrapped, cell.u);
    place.y = sample_latitude_tent(row, first.height, cell.v) * kInvPi * first.height;
  }
  return {direction_of(environment_, textures_, place), weight_at(place) / texels_.total()};
}

double EnvironmentLight::pdf(const Vec3& unit_direction) const {
  return empty() ? 0
                 : weight_at(place_of(environment_, textures_, unit_direction)) / texels_.total();
}

}  // namespace bandsaw
