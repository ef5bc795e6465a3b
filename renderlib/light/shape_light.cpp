// Computes the area of each kind of shape, samples a point on it, and returns the pdf of the
// direction to a point.

#include "renderlib/light/shape_light.h"

#include <algorithm>
#include <cmath>

#include "renderlib/light/ellipsoid_light.h"
#include "renderlib/sampling/sphere_light.h"
#include "renderlib/sampling/spherical_rectangle.h"
#include "renderlib/sampling/spherical_triangle.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

using Kind = ShapeView::Kind;

/// Returns the rectangle as seen from `from`, for sampling by solid angle; std::nullopt if the
/// shape is no rectangle or can only be sampled by area.
std::optional<SphericalRectangle> seen_rectangle(const ShapeView& shape, const Vec3& from) {
  if (shape.kind != Kind::kQuad || !is_rectangle(shape.u, shape.v)) {
    return std::nullopt;
  }
  return SphericalRectangle::seen_from(from, shape.a, shape.u, shape.v);
}

/// Returns the triangle as seen from `from`, for sampling by solid angle; std::nullopt if the shape
/// is no triangle or can only be sampled by area.
std::optional<SphericalTriangle> seen_triangle(const ShapeView& shape, const Vec3& from) {
  return shape.kind == Kind::kTriangle
             ? SphericalTriangle::seen_from(from, shape.a, shape.u, shape.v)
             : std::nullopt;
}

/// Returns the coordinates, along ShapeView::u and v, of a point that is uniform by area. In a
/// parallelogram the point is (u, v) itself. In a triangle the square root makes the distance from
/// the first vertex uniform in area (Pharr, Jakob and Humphreys, "Physically Based Rendering",
/// A.5.4).
Vec2 uniform_on(Kind kind, double u, double v) {
  if (kind == Kind::kQuad) {
    return {u, v};
  }
  if (kind == Kind::kDisk) {
    return sample_disk(u, v);
  }
  const double far = std::sqrt(u);
  return {far * (1 - v), far * v};
}

/// Samples a flat shape uniformly: by solid angle if it is a rectangle or triangle for which this
/// is possible, otherwise by area.
std::optional<ShapeSample> sample_flat(const ShapeView& shape, const Vec3& from, double u,
                                       double v) {
  const Vec3 normal = flat_normal(shape);
  ShapeSample sample;
  sample.normal = normalize(normal);
  const std::optional<SphericalRectangle> rectangle = seen_rectangle(shape, from);
  const std::optional<SphericalTriangle> triangle = seen_triangle(shape, from);
  sample.on_shape = rectangle  ? rectangle->sample(u, v)
                    : triangle ? triangle->sample(u, v)
                               : uniform_on(shape.kind, u, v);
  sample.position = shape.a + shape.u * sample.on_shape.x + shape.v * sample.on_shape.y;
  sample.pdf = rectangle  ? 1 / rectangle->solid_angle()
               : triangle ? 1 / triangle->solid_angle()
                          : solid_angle_pdf(1 / area(shape), from, sample.position, sample.normal);
  return sample;
}

}  // namespace

double area(const ShapeView& shape) {
  if (shape.kind == Kind::kSphere) {
    return 4 * kPi * shape.radius * shape.radius;
  }
  if (shape.kind == Kind::kEllipsoid) {
    return ellipsoid_area(shape);
  }
  const double parallelogram = length(cross(shape.u, shape.v));
  return shape.kind == Kind::kQuad   ? parallelogram
         : shape.kind == Kind::kDisk ? kPi * parallelogram
                                     : parallelogram / 2;
}

Vec3 flat_normal(const ShapeView& shape) {
  return shape.mirrored ? cross(shape.v, shape.u) : cross(shape.u, shape.v);
}

Ball bounds(const ShapeView& shape) {
  if (shape.kind == Kind::kSphere) {
    return {shape.a, shape.radius};
  }
  if (shape.kind == Kind::kDisk || shape.kind == Kind::kEllipsoid) {
    // No semi-axis is longer than the root of the sum of all squared axes.
    const double square =
        length_squared(shape.u) + length_squared(shape.v) + length_squared(shape.w);
    return {shape.a, std::sqrt(square)};
  }
  if (shape.kind == Kind::kQuad) {
    const double diagonal = std::max(length(shape.u + shape.v), length(shape.u - shape.v));
    return {shape.a + (shape.u + shape.v) / 2, diagonal / 2};
  }
  const Vec3 center = (shape.u + shape.v) / 3;
  const double radius =
      std::sqrt(std::max({length_squared(center), length_squared(shape.u - center),
                          length_squared(shape.v - center)}));
  return {shape.a + center, radius};
}

std::optional<ShapeSample> sample(const ShapeView& shape, const Vec3& from, double u, double v) {
  std::optional<ShapeSample> sample;
  if (shape.kind == Kind::kSphere) {
    if (const auto on_sphere = sample_sphere_light(shape.a, shape.radius, from, u, v)) {
      sample = ShapeSample{on_sphere->position, on_sphere->normal, {}, on_sphere->pdf};
    }
  } else if (shape.kind == Kind::kEllipsoid) {
    sample = sample_ellipsoid(shape, from, u, v);
  } else {
    sample = sample_flat(shape, from, u, v);
  }
  return sample && sample->pdf > 0 && std::isfinite(sample->pdf) ? sample : std::nullopt;
}

double direction_pdf(const ShapeView& shape, const Vec3& from, const Vec3& position,
                     const Vec3& normal) {
  if (shape.kind == Kind::kSphere) {
    return sphere_light_pdf(shape.a, shape.radius, from, position, normal);
  }
  if (const std::optional<SphericalRectangle> rectangle = seen_rectangle(shape, from)) {
    return 1 / rectangle->solid_angle();
  }
  if (const std::optional<SphericalTriangle> triangle = seen_triangle(shape, from)) {
    return 1 / triangle->solid_angle();
  }
  const double by_area =
      shape.kind == Kind::kEllipsoid ? ellipsoid_area_pdf(shape, position) : 1 / area(shape);
  const double pdf = solid_angle_pdf(by_area, from, position, normal);
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace bandsaw
