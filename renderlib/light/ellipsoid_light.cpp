// An ellipsoid is a unit sphere that an affine map has stretched. A uniform point of the sphere is
// mapped to the ellipsoid. The pdf by area is that of the sphere divided by the local area scale of
// the map.

#include "renderlib/light/ellipsoid_light.h"

#include <cmath>

#include "renderlib/geometry/intersect.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Cofactors of the affine map from the unit sphere to the ellipsoid. They transform normals. The
/// length of a transformed unit normal is the factor by which the map scales areas perpendicular to
/// this normal.
struct Cofactors {
  explicit Cofactors(const ShapeView& shape)
      : x(exact_cross(shape.v, shape.w)),
        y(exact_cross(shape.w, shape.u)),
        z(exact_cross(shape.u, shape.v)),
        determinant(dot(shape.u, x)) {}

  /// Transforms the unit normal `s` of the sphere; the result is not normalised.
  Vec3 times(const Vec3& s) const { return x * s.x + y * s.y + z * s.z; }
  /// Applies the inverse of the map to a vector in world space.
  Vec3 back(const Vec3& p) const { return Vec3{dot(x, p), dot(y, p), dot(z, p)} / determinant; }

  Vec3 x;
  Vec3 y;
  Vec3 z;
  double determinant;
};

}  // namespace

std::optional<ShapeSample> sample_ellipsoid(const ShapeView& shape, const Vec3& from, double u,
                                            double v) {
  const Cofactors cofactors(shape);
  const Vec3 on_sphere = sample_sphere(u, v);
  const Vec3 outward = cofactors.times(on_sphere) * (cofactors.determinant < 0 ? -1 : 1);
  ShapeSample sample;
  sample.position = shape.a + shape.u * on_sphere.x + shape.v * on_sphere.y + shape.w * on_sphere.z;
  sample.normal = normalize(outward);
  sample.pdf = solid_angle_pdf(kSpherePdf / length(outward), from, sample.position, sample.normal);
  return sample;
}

double ellipsoid_area_pdf(const ShapeView& shape, const Vec3& position) {
  const Cofactors cofactors(shape);
  return kSpherePdf / length(cofactors.times(normalize(cofactors.back(position - shape.a))));
}

double ellipsoid_area(const ShapeView& shape) {
  const Cofactors cofactors(shape);
  // `sum` is the mean, over the sphere, of the map's local area scale. It is computed by the
  // cubature of degree 5 on the 6 face centres and 8 corners of a cube (weights 1/15 and 3/40).
  // Opposite points have equal values, so half of them are evaluated.
  double sum = 0;
  for (const Vec3& face : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    sum += 2 * length(cofactors.times(face)) / 15;
  }
  const double corner = std::sqrt(1.0 / 3);
  for (const double y : {-corner, corner}) {
    for (const double z : {-corner, corner}) {
      sum += 2 * length(cofactors.times({corner, y, z})) * 3 / 40;
    }
  }
  return 4 * kPi * sum;
}

}  // namespace bandsaw
