// Checks the environment and each kind of delta light, field by field.

#include "renderlib/light/check_lights.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

/// Within this bound, squares of distances do not overflow a double.
constexpr double kMaxCoordinate = 1e30;
/// Tolerances of the squared length of unit vectors, and of the dot products of vectors at right
/// angles. They admit vectors that were normalised in double and rounded a few times.
constexpr double kUnit = 1e-9;
constexpr double kOrthonormal = 1e-9;

bool is_orthonormal(const Basis& axes) {
  const auto near = [](double a, double b) { return std::abs(a - b) <= kOrthonormal; };
  return near(length_squared(axes.x), 1) && near(length_squared(axes.y), 1) &&
         near(length_squared(axes.z), 1) && near(dot(axes.x, axes.y), 0) &&
         near(dot(axes.y, axes.z), 0) && near(dot(axes.z, axes.x), 0);
}

absl::Status invalid(const std::string& field, const std::string& why) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", why));
}

absl::Status check_color(const std::string& field, const Rgb& c) {
  if (is_finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0) {
    return absl::OkStatus();
  }
  return invalid(field,
                 absl::StrCat("must be finite and >= 0, is [", c.r, ", ", c.g, ", ", c.b, "]"));
}

absl::Status check_unit(const std::string& field, const Vec3& d) {
  if (std::abs(length_squared(d) - 1) <= kUnit) {
    return absl::OkStatus();
  }
  return invalid(field,
                 absl::StrCat("must be a unit vector, is [", d.x, ", ", d.y, ", ", d.z, "]"));
}

absl::Status check_position(const std::string& field, const Vec3& p) {
  if (is_finite(p) && max_abs(p) <= kMaxCoordinate) {
    return absl::OkStatus();
  }
  return invalid(field, absl::StrCat("must be within +-", kMaxCoordinate, ", is [", p.x, ", ", p.y,
                                     ", ", p.z, "]"));
}

/// Checks one delta light.
struct Check {
  absl::Span<const Texture> textures;

  /// Checks the image that a light projects. `axis` and `intensity` are those of the light.
  absl::Status image(const std::string& field, const ProjectedImage& image, const Vec3& axis,
                     const Rgb& intensity) const {
    const std::size_t index = index_of(image.texture);
    if (index >= textures.size()) {
      return invalid(field + ".texture",
                     absl::StrCat("must be below ", textures.size(), ", is ", index));
    }
    if (!is_orthonormal({image.right, image.up, axis})) {
      return invalid(field + ".right, .up",
                     "must be unit vectors at right angles to each other and to the axis");
    }
    for (const double half : {image.half_width, image.half_height}) {
      if (!(half >= kMinHalfImage && half <= kMaxHalfImage)) {
        return invalid(field + ".half_width, .half_height",
                       absl::StrCat("must be in [1e-9, 1e9], one is ", half));
      }
    }
    const float most =
        max_value(textures, image.texture) * std::max({intensity.r, intensity.g, intensity.b});
    if (!std::isfinite(most)) {
      return invalid(field + ".texture", "its largest value times the intensity must be finite");
    }
    return absl::OkStatus();
  }

  absl::Status operator()(const DirectionalLight& light) const {
    RETURN_IF_ERROR(check_unit("directional.direction", light.direction));
    return check_color("directional.irradiance", light.irradiance);
  }
  absl::Status operator()(const PointLight& light) const {
    RETURN_IF_ERROR(check_position("point.position", light.position));
    return check_color("point.intensity", light.intensity);
  }
  absl::Status operator()(const SpotLight& light) const {
    RETURN_IF_ERROR(check_position("spot.position", light.position));
    RETURN_IF_ERROR(check_unit("spot.direction", light.direction));
    RETURN_IF_ERROR(check_color("spot.intensity", light.intensity));
    if (!(light.cos_outer >= 0 && light.cos_outer <= light.cos_inner && light.cos_inner <= 1)) {
      return invalid(
          "spot.cos_outer",
          absl::StrCat("must be in [0, cos_inner], and cos_inner at most 1; cos_outer is ",
                       light.cos_outer, ", cos_inner is ", light.cos_inner));
    }
    return light.image ? image("spot.image", *light.image, light.direction, light.intensity)
                       : absl::OkStatus();
  }
  absl::Status operator()(const ProjectorLight& light) const {
    RETURN_IF_ERROR(check_position("projector.position", light.position));
    RETURN_IF_ERROR(check_unit("projector.direction", light.direction));
    RETURN_IF_ERROR(check_color("projector.intensity", light.intensity));
    return image("projector.image", light.image, light.direction, light.intensity);
  }
};

absl::Status check_environment(const Environment& environment, absl::Span<const Texture> textures) {
  const bool cube = environment.kind == Environment::Kind::kCube;
  const std::size_t count = cube ? 6 : 1;
  if (environment.images.size() != count) {
    return invalid(
        "images", absl::StrCat("there must be ", count, ", there are ", environment.images.size()));
  }
  if (!(environment.strength >= 0) || !std::isfinite(environment.strength)) {
    return invalid("strength", absl::StrCat("must be finite and >= 0, is ", environment.strength));
  }
  if (!is_orthonormal(environment.axes)) {
    return invalid("axes", "must be three unit vectors at right angles");
  }
  std::uint32_t side = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string field = absl::StrCat("images[", i, "]");
    const std::size_t index = index_of(environment.images[i]);
    if (index >= textures.size()) {
      return invalid(field, absl::StrCat("must be below ", textures.size(), ", is ", index));
    }
    const auto* image = std::get_if<ImageTexture>(&textures[index]);
    if (image == nullptr) {
      return invalid(field, "must be an image");
    }
    side = i == 0 ? image->width : side;
    if (cube && (image->width != side || image->height != side)) {
      return invalid(
          field, absl::StrCat("images of a cube map must be square and of one size; this one has ",
                              image->width, " x ", image->height, " pixels, the first is ", side,
                              " wide"));
    }
    // Textures are also used for materials, so they may hold numbers that no light can have.
    const float most = max_value(textures, environment.images[i]);
    if (!std::isfinite(most * environment.strength)) {
      return invalid(field, absl::StrCat("its largest value times the strength must be finite, is ",
                                         most * environment.strength));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_lights(const Background& background, absl::Span<const Texture> textures,
                          const std::vector<DeltaLight>& lights) {
  if (background.environment) {
    if (const absl::Status good = check_environment(*background.environment, textures);
        !good.ok()) {
      return invalid("background.environment", std::string(good.message()));
    }
  }
  std::size_t directional = 0;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (const absl::Status good = std::visit(Check{textures}, lights[i]); !good.ok()) {
      return invalid(absl::StrCat("light[", i, "]"), std::string(good.message()));
    }
    directional += std::holds_alternative<DirectionalLight>(lights[i]) ? 1 : 0;
  }
  if (directional > kMaxDirectionalLights) {
    return invalid("light", absl::StrCat("at most ", kMaxDirectionalLights,
                                         " may be directional, there are ", directional));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
