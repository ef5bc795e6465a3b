// arrival() computes the illumination at a point for each kind of light; falloff and projected
// images have functions of their own.

#include "renderlib/light/delta_light.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Upper bound of an irradiance relative to the intensity, so that products stay finite.
constexpr double kMaxShare = 1e30;

/// Returns 1 / length^2, at most kMaxShare; 0 if the length is 0, i.e. at the position of the
/// light.
float over_distance2(const Vec3& to_light) {
  const double distance2 = length_squared(to_light);
  return distance2 > 0 ? static_cast<float>(std::min(1 / distance2, kMaxShare)) : 0.0f;
}

/// Returns the coordinates at which the direction `from_light` meets the plane of the image, as
/// multiples of the image's half sides. `depth`, the component of `from_light` along the axis, MUST
/// be > 0.
Vec2 on_image(const ProjectedImage& image, const Vec3& from_light, double depth) {
  return {dot(from_light, image.right) / (depth * image.half_width),
          dot(from_light, image.up) / (depth * image.half_height)};
}

/// Returns the image's value at the coordinates `place` that on_image() returns.
Rgb value_at(const ProjectedImage& image, const std::vector<Texture>& textures, const Vec2& place) {
  const Vec2 uv{0.5 + 0.5 * place.x, 0.5 + 0.5 * place.y};
  return evaluate(textures, image.texture, {.uv = uv, .uv2 = uv});
}

/// Returns the share of the intensity that a spot light emits at this cosine of the angle to its
/// axis.
double falloff_at(const SpotLight& light, double cosine) {
  if (cosine <= light.cos_outer) {
    return 0;
  }
  if (cosine >= light.cos_inner) {
    return 1;
  }
  if (light.falloff == SpotLight::Falloff::kLinearAngle) {
    const double outer = acos(light.cos_outer);
    return (outer - acos(cosine)) / (outer - acos(light.cos_inner));
  }
  const double ramp = (cosine - light.cos_outer) / (light.cos_inner - light.cos_outer);
  return light.falloff == SpotLight::Falloff::kSmooth ? ramp * ramp * (3 - 2 * ramp) : ramp * ramp;
}

/// Transforms the axis of a light and the image that it projects.
void place(const Transform& to, Vec3& axis, ProjectedImage& image) {
  axis = normalize(to.direction(axis));
  // `right` and `up` are made perpendicular again, whatever the transform does to angles. If the
  // transform mirrors, the image is mirrored too.
  const Vec3 right = to.direction(image.right);
  image.right = normalize(right - axis * dot(axis, right));
  const Vec3 up = cross(axis, image.right);
  image.up = dot(up, to.direction(image.up)) < 0 ? -up : up;
}

/// Computes placed() for each kind of light.
struct Placed {
  const Transform& to;

  DeltaLight operator()(DirectionalLight light) const {
    light.direction = normalize(to.direction(light.direction));
    return light;
  }
  DeltaLight operator()(PointLight light) const {
    light.position = to.point(light.position);
    return light;
  }
  DeltaLight operator()(SpotLight light) const {
    light.position = to.point(light.position);
    if (light.image) {
      place(to, light.direction, *light.image);
    } else {
      light.direction = normalize(to.direction(light.direction));
    }
    return light;
  }
  DeltaLight operator()(ProjectorLight light) const {
    light.position = to.point(light.position);
    place(to, light.direction, light.image);
    return light;
  }
};

}  // namespace

DeltaLight placed(const DeltaLight& light, const Transform& to) {
  return std::visit(Placed{to}, light);
}

Arrival arrival(const DirectionalLight& light, const std::vector<Texture>&, const Vec3&) {
  return {-light.direction, light.irradiance};
}

Arrival arrival(const PointLight& light, const std::vector<Texture>&, const Vec3& at) {
  const Vec3 to_light = light.position - at;
  return {to_light, light.intensity * over_distance2(to_light)};
}

Arrival arrival(const SpotLight& light, const std::vector<Texture>& textures, const Vec3& at) {
  const Vec3 to_light = light.position - at;
  const double distance = length(to_light);
  const double cosine = distance > 0 ? -dot(to_light, light.direction) / distance : 0;
  const double share = falloff_at(light, cosine);
  if (!(share > 0)) {
    return {to_light, {}};
  }
  const Rgb arrives = light.intensity * (over_distance2(to_light) * static_cast<float>(share));
  if (!light.image) {
    return {to_light, arrives};
  }
  const Vec2 place = on_image(*light.image, -to_light, cosine * distance);
  return {to_light, arrives * value_at(*light.image, textures, place)};
}

Arrival arrival(const ProjectorLight& light, const std::vector<Texture>& textures, const Vec3& at) {
  const Vec3 to_light = light.position - at;
  const double depth = -dot(to_light, light.direction);
  if (!(depth > 0)) {
    return {to_light, {}};
  }
  const Vec2 place = on_image(light.image, -to_light, depth);
  if (!(std::abs(place.x) <= 1 && std::abs(place.y) <= 1)) {
    return {to_light, {}};
  }
  // 1 / (distance^2 cos^3) = distance / depth^3
  const double share = std::min(length(to_light) / (depth * depth * depth), kMaxShare);
  return {to_light,
          light.intensity * value_at(light.image, textures, place) * static_cast<float>(share)};
}

}  // namespace bandsaw
