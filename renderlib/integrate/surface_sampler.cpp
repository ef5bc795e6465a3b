// A primitive is found by bisection in the sums of the areas. The kind of its shape determines how
// a place on the primitive is sampled.

#include "renderlib/integrate/surface_sampler.h"

#include <algorithm>
#include <cmath>

#include "renderlib/light/ellipsoid_light.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// A random place on a shape, uniform except on ellipsoids.
struct Place {
  Vec3 position;
  Vec2 on_shape;  ///< Hit::u and Hit::v of the place
};

/// Returns the place on the shape that the random numbers `u` and `v`, in [0, 1), select.
Place place_on(const ShapeView& shape, double u, double v) {
  using Kind = ShapeView::Kind;
  if (shape.kind == Kind::kSphere) {
    return {shape.a + sample_sphere(u, v) * shape.radius, {}};
  }
  if (shape.kind == Kind::kEllipsoid) {
    const Vec3 on_ball = sample_sphere(u, v);
    return {shape.a + shape.u * on_ball.x + shape.v * on_ball.y + shape.w * on_ball.z, {}};
  }
  Vec2 at{u, v};
  if (shape.kind == Kind::kDisk) {
    at = sample_disk(u, v);
  } else if (shape.kind == Kind::kTriangle) {
    const double far = std::sqrt(u);
    at = {far * (1 - v), far * v};
  }
  return {shape.a + shape.u * at.x + shape.v * at.y, at};
}

}  // namespace

bool SurfaceSampler::add(const Scene& scene, PrimitiveId id) {
  const double before = primitives_.empty() ? 0 : primitives_.back().area_up_to;
  const double size = area(shape_view(scene.geometry(), id, middle_of(shutter_of(scene.camera()))));
  if (!(size > 0)) {
    return true;
  }
  if (!std::isfinite(before + size)) {
    return false;
  }
  primitives_.push_back({id, before + size});
  return true;
}

std::optional<SurfaceSample> SurfaceSampler::sample(const Scene& scene, double primitive, double u,
                                                    double v, double time) const {
  const double total = primitives_.back().area_up_to;
  const auto found =
      std::upper_bound(primitives_.begin(), primitives_.end() - 1, primitive * total,
                       [](double area, const Primitive& one) { return area < one.area_up_to; });
  // surface_at() computes the surface point from a ray and a hit: on a sphere or an ellipsoid from
  // the end of the ray, on other shapes from Hit::u and Hit::v.
  const ShapeView shape = shape_view(scene.geometry(), found->id, time);
  const Place place = place_on(shape, u, v);
  const Ray ray{
      .origin = shape.kind == ShapeView::Kind::kSphere || shape.kind == ShapeView::Kind::kEllipsoid
                    ? shape.a
                    : place.position,
      .direction = place.position - shape.a,
      .time = time};
  const Hit hit{.t = 1, .id = found->id, .u = place.on_shape.x, .v = place.on_shape.y};
  SurfaceSample sample{surface_at(scene.geometry(), ray, hit, scene.features().uv), 1 / total};
  if (scene.moves()) {
    // The primitive was chosen by its area in the middle of the shutter interval.
    const double before = found == primitives_.begin() ? 0 : std::prev(found)->area_up_to;
    sample.pdf *= (found->area_up_to - before) / area(shape);
  }
  if (shape.kind == ShapeView::Kind::kEllipsoid) {
    sample.pdf *= area(shape) * ellipsoid_area_pdf(shape, place.position);
  }
  return std::isfinite(sample.pdf) && is_finite(sample.point.position) ? std::optional(sample)
                                                                       : std::nullopt;
}

}  // namespace bandsaw
