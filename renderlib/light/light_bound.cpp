// Bounds of shapes and delta lights, and their importance: intensity, times the largest cosines at
// the light and at the receiver, over the squared distance.

#include "renderlib/light/light_bound.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// LightBound::cos_reach of a spot light and a projector, which emit nothing beyond the cone. The
/// value is a little less than 1, so that rounding does not exclude directions at the cone's rim.
constexpr double kJustFacing = 1 - 0x1p-40;

/// Minimum distance of a light from a ray, as a part of the distance between the light and the
/// origin of the ray.
constexpr double kMinAside = 1e-6;

/// Upper bound of an importance, so that sums and ratios stay finite.
constexpr double kMaxImportance = 1e300;

/// An angle in [0, 180] degrees, given by its sine and cosine.
struct Angle {
  double sin;
  double cos;
};

Angle angle_of(double cosine) {
  const double c = std::clamp(cosine, -1.0, 1.0);
  return {std::sqrt((1 - c) * (1 + c)), c};
}

/// Returns a - b, clamped at 0.
Angle reduced(const Angle& a, const Angle& b) {
  if (a.cos >= b.cos) {
    return {0, 1};
  }
  return {a.sin * b.cos - a.cos * b.sin, a.cos * b.cos + a.sin * b.sin};
}

}  // namespace

// The intensity is the radiance times the largest projected area. The projected area of a convex
// body, such as an ellipsoid, is at most half its surface.
LightBound bound_of(const ShapeView& shape, double radiance, bool one_sided) {
  if (shape.kind == ShapeView::Kind::kSphere) {
    return {.ball = bounds(shape), .intensity = radiance * kPi * shape.radius * shape.radius};
  }
  if (!is_flat(shape)) {
    return {.ball = bounds(shape), .intensity = radiance * area(shape) / 2};
  }
  return {.ball = bounds(shape),
          .intensity = radiance * area(shape),
          .axis = normalize(flat_normal(shape)),
          .cos_spread = 1,
          .two_sided = !one_sided,
          .flat = true};
}

LightBound bound_of(const PointLight& light) {
  return {.ball = {light.position, 0}, .intensity = brightness(light.intensity)};
}

LightBound bound_of(const SpotLight& light, const std::vector<Texture>& textures) {
  const Rgb image = light.image ? mean(textures, light.image->texture) : gray(1);
  // The intensity of a spot light is not a cosine. The bound is that of a surface whose normals
  // cover all directions up to the outer angle. Such a surface has the full intensity in each of
  // these directions.
  return {.ball = {light.position, 0},
          .intensity = brightness(light.intensity * image),
          .axis = light.direction,
          .cos_spread = light.cos_outer,
          .cos_reach = kJustFacing};
}

LightBound bound_of(const ProjectorLight& light, const std::vector<Texture>& textures) {
  const double width2 = light.image.half_width * light.image.half_width;
  const double height2 = light.image.half_height * light.image.half_height;
  // Radiant intensity is image * intensity / cos^3, and a part of the image at distance 1 has the
  // solid angle area * cos^3. So the power is intensity times the area of the image; divided by the
  // solid angle of the whole image, it gives the mean radiant intensity.
  const double area = 4 * light.image.half_width * light.image.half_height;
  const double sine =
      light.image.half_width * light.image.half_height / std::sqrt((1 + width2) * (1 + height2));
  const double solid_angle = 4 * asin(sine);
  const Rgb value = light.intensity * mean(textures, light.image.texture);
  return {.ball = {light.position, 0},
          .intensity = brightness(value) * area / solid_angle,
          .axis = light.direction,
          .cos_spread = 1 / std::sqrt(1 + width2 + height2),
          .cos_reach = kJustFacing};
}

double importance(const LightBound& bound, const Receiver& receiver) {
  const Vec3 to_light = bound.ball.center - receiver.position;
  const double distance2 = length_squared(to_light);
  const double radius = bound.ball.radius;
  const double near2 = std::max(distance2, radius * radius);
  if (!(near2 > 0)) {
    return 0;  // The receiver coincides with a light without extent.
  }
  const double given = std::min(bound.intensity / near2, kMaxImportance);
  if (bound.flat) {
    const double height = -dot(bound.axis, to_light);
    if (height == 0 || (height < 0 && !bound.two_sided)) {
      return 0;
    }
  }
  if (distance2 <= radius * radius) {
    return given;
  }
  const double distance = std::sqrt(distance2);
  // `seen` is half the angle under which the ball is seen. Angles to the ball's centre are reduced
  // by it, which gives the largest cosine for any point of the ball.
  const double sin_seen = radius / distance;
  const Angle seen{sin_seen, std::sqrt((1 - sin_seen) * (1 + sin_seen))};
  if (receiver.within != nullptr) {
    const Cone& cone = *receiver.within;
    const Angle off = angle_of(dot(cone.axis, to_light) / distance);
    if (reduced(reduced(off, {cone.sin, cone.cos}), seen).cos < 1) {
      return 0;
    }
  }
  double cosines = 1;
  if (receiver.normal) {
    cosines = reduced(angle_of(dot(*receiver.normal, to_light) / distance), seen).cos;
    if (cosines <= 0) {
      return 0;
    }
  }
  if (bound.cos_spread > -1) {
    const double along_axis = -dot(bound.axis, to_light) / distance;
    const Angle off = angle_of(bound.two_sided ? std::abs(along_axis) : along_axis);
    const double facing = reduced(reduced(off, angle_of(bound.cos_spread)), seen).cos;
    if (facing <= bound.cos_reach) {
      return 0;
    }
    cosines *= facing;
  }
  return given * cosines;
}

double importance(const LightBound& bound, const ReceiverSegment& segment) {
  const Vec3 to_light = bound.ball.center - segment.origin;
  const double nearest = segment.nearest(bound.ball.center);
  const double aside = std::max({length(to_light - segment.direction * nearest), bound.ball.radius,
                                 kMinAside * length(to_light)});
  if (!(aside > 0)) {
    return kMaxImportance;
  }
  const double angle = std::min(kPi, segment.length / aside);
  const double given =
      bound.intensity * exp(-segment.extinction * (nearest + aside)) * angle / aside;
  return std::min(given, kMaxImportance);
}

}  // namespace bandsaw
