#pragma once

// Points on the shapes of a scene as a receiver sees them: sampled by solid angle where there is a
// closed form (spheres from outside, rectangles, triangles that are not small), else uniformly over
// their area.

#include <optional>

#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// A shape of the scene in world space. A disk may have become an ellipse there, a sphere an
/// ellipsoid.
struct ShapeView {
  enum class Kind { kSphere, kQuad, kTriangle, kDisk, kEllipsoid };
  Kind kind = Kind::kTriangle;
  Vec3 a;    ///< sphere, disk, ellipsoid: center; quad: corner; triangle: first vertex
  Vec3 u{};  ///< quad, triangle: edges from a; disk, ellipsoid: what a unit circle or sphere in its
             ///< own axes is mapped by
  Vec3 v{};
  Vec3 w{};               ///< ellipsoid
  double radius = 0;      ///< sphere
  bool mirrored = false;  ///< by its placement: the outward normal is v x u
};

/// `id` MUST name a primitive of the geometry; where it is at `time`.
ShapeView shape_view(const Geometry& geometry, PrimitiveId id, double time);
MaterialId material_of(const Geometry& geometry, PrimitiveId id);

inline bool is_flat(const ShapeView& shape) {
  return shape.kind != ShapeView::Kind::kSphere && shape.kind != ShapeView::Kind::kEllipsoid;
}

/// Of one side. Of an ellipsoid only within a few percent: what chooses among lights needs no more.
double area(const ShapeView& shape);
/// u x v to the outside; not normalised. Flat shapes only.
Vec3 flat_normal(const ShapeView& shape);

/// A ball around the shape.
struct Ball {
  Vec3 center;
  double radius = 0;
};
Ball bounds(const ShapeView& shape);
/// Around a primitive of a moving instance wherever it gets to during the interval.
Ball moving_ball(const Geometry& geometry, PrimitiveId id, const Interval& interval);

struct ShapeSample {
  Vec3 position;
  Vec3 normal;     ///< unit, to the outside
  Vec2 on_shape;   ///< Hit::u, Hit::v of the position
  double pdf = 0;  ///< of the direction to the position, by solid angle; > 0, finite
};

/// A point of the shape as `from` sees it; u, v in [0, 1). Nothing when it has no density as a
/// direction (seen edge-on).
std::optional<ShapeSample> sample(const ShapeView& shape, const Vec3& from, double u, double v);

/// The density with which sample() makes the direction to `position`, a point of the shape with
/// unit normal `normal`.
double direction_pdf(const ShapeView& shape, const Vec3& from, const Vec3& position,
                     const Vec3& normal);

}  // namespace bandsaw
