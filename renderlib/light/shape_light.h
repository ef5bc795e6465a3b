#pragma once

// Samples points on emissive shapes as seen from a receiver (light/lights.h). Spheres seen from
// outside, rectangles, and triangles that are not small are sampled by solid angle, because a
// closed form exists. Other shapes are sampled over their area, uniformly except on ellipsoids.

#include <optional>

#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// A shape of the scene in world space. Placement may turn a disk into an ellipse and a sphere into
/// an ellipsoid.
struct ShapeView {
  enum class Kind { kSphere, kQuad, kTriangle, kDisk, kEllipsoid };
  Kind kind = Kind::kTriangle;
  Vec3 a;  ///< sphere, disk, ellipsoid: center; quad: corner; triangle: first vertex
  /// Quad, triangle: edges from `a`. Disk, ellipsoid: images of the axes of the unit circle or
  /// sphere.
  Vec3 u{};
  Vec3 v{};
  Vec3 w{};               ///< ellipsoid: image of the third axis
  double radius = 0;      ///< sphere
  bool mirrored = false;  ///< true if the placement mirrors; then the outward normal is v x u
};

/// Returns the primitive at the given time. `id` MUST name a primitive of the geometry.
ShapeView shape_view(const Geometry& geometry, PrimitiveId id, double time);
MaterialId material_of(const Geometry& geometry, PrimitiveId id);

inline bool is_flat(const ShapeView& shape) {
  return shape.kind != ShapeView::Kind::kSphere && shape.kind != ShapeView::Kind::kEllipsoid;
}

/// Returns the area of one side. For an ellipsoid it is accurate only to a few percent, which is
/// enough for the selection of lights.
double area(const ShapeView& shape);
/// Returns u x v oriented to the outside, not normalised. The shape MUST be flat.
Vec3 flat_normal(const ShapeView& shape);

/// Bounding sphere of a shape.
struct Ball {
  Vec3 center;
  double radius = 0;
};
Ball bounds(const ShapeView& shape);
/// Returns a sphere that bounds the primitive `id` during the whole of Geometry::shutter. The
/// primitive belongs to an instance, which may move (geometry/placement.h).
Ball moving_ball(const Geometry& geometry, PrimitiveId id);

/// A point sampled on a shape.
struct ShapeSample {
  Vec3 position;
  Vec3 normal;     ///< unit, outward
  Vec2 on_shape;   ///< `Hit::u`, `Hit::v` of the position
  double pdf = 0;  ///< pdf of the direction to the position, by solid angle; > 0, finite
};

/// Samples a point of the shape as seen from `from`; u, v in [0, 1). Returns std::nullopt if the
/// direction has no finite pdf (shape seen edge-on).
std::optional<ShapeSample> sample(const ShapeView& shape, const Vec3& from, double u, double v);

/// Returns the pdf, by solid angle, with which `sample()` samples the direction to `position`, a
/// point of the shape with unit normal `normal`.
double direction_pdf(const ShapeView& shape, const Vec3& from, const Vec3& position,
                     const Vec3& normal);

}  // namespace bandsaw
