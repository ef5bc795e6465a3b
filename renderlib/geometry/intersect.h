#pragma once

// Ray-primitive intersection. Each kind of primitive has one deterministic function in double,
// which depends only on the ray and the primitive. This function decides every hit, so the closest
// hit does not depend on the BVH.

#include <algorithm>
#include <cmath>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/geometry/traced_ray.h"
#include "renderlib/math/fused.h"

namespace bandsaw {

/// An intersection at the distance t in (0, t_max). u and v give the position on the primitive, for
/// example the barycentric weights of the corners b and c of a triangle. All members are those of
/// Hit (geometry/ray.h).
struct Crossing {
  double t;
  double u;
  double v;
  const float* corners = nullptr;
};

/// Returns a b - c d with the exact sign, within 1.5 units in the last place (Kahan). So two
/// triangles that share an edge agree on which side of the edge the ray passes.
inline double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = product_error(-c, d, -cd);
  return fused(a, b, -cd) + error;
}

/// Returns cross(a, b), each component within 1.5 units in the last place, also if products cancel.
inline Vec3 exact_cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}

/// A point in the ray's space, in which the ray starts at the origin and is the z axis.
struct Sheared {
  double x;
  double y;
  double z;
};

/// Returns the point `p` in the ray's space. `Point` is an array of three numbers, float or double.
template <class Point>
[[gnu::always_inline]] inline Sheared sheared(const TracedRay& ray, const Point& p) {
  const auto kx = static_cast<std::size_t>(ray.kx);
  const auto ky = static_cast<std::size_t>(ray.ky);
  const auto kz = static_cast<std::size_t>(ray.kz);
  const double z = p[kz] - ray.origin[kz];
  return {(p[kx] - ray.origin[kx]) - ray.shear_x * z, (p[ky] - ray.origin[ky]) - ray.shear_y * z,
          z};
}

/// Intersects a triangle, from both sides and including its edges: a ray through an edge that
/// triangles share hits at least one of these triangles (Woop, Benthin, Wald 2013, "Watertight
/// Ray/Triangle Intersection", JCGT 2(1)). `a`, `b` and `c` are the corners in the triangle's
/// space; `at_a`, `at_b` and `at_c` are the same corners in the ray's space. Returns true and sets
/// `crossing`, except its `corners`, if the triangle is hit.
template <class Point>
[[gnu::always_inline]] inline bool intersect_sheared(const TracedRay& ray, const Point& a,
                                                     const Point& b, const Point& c,
                                                     const Sheared& at_a, const Sheared& at_b,
                                                     const Sheared& at_c, Crossing& crossing) {
  const double weight_a = difference_of_products(at_c.x, at_b.y, at_c.y, at_b.x);
  const double weight_b = difference_of_products(at_a.x, at_c.y, at_a.y, at_c.x);
  const double weight_c = difference_of_products(at_b.x, at_a.y, at_b.y, at_a.x);
  if ((weight_a < 0 || weight_b < 0 || weight_c < 0) &&
      (weight_a > 0 || weight_b > 0 || weight_c > 0)) {
    return false;
  }
  const double sum = weight_a + weight_b + weight_c;
  if (sum == 0) {
    return false;
  }
  const double scale = 1 / sum;
  double t = (weight_a * at_a.z + weight_b * at_b.z + weight_c * at_c.z) * scale * ray.shear_z;
  double lo[3];
  double hi[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [least, most] = std::minmax({double{a[k]}, double{b[k]}, double{c[k]}});
    lo[k] = least;
    hi[k] = most;
  }
  if (!clip_to_box(ray, lo, hi, t) || !(t > 0 && t < ray.t_max)) {
    return false;
  }
  crossing = {t, std::clamp(weight_b * scale, 0.0, 1.0), std::clamp(weight_c * scale, 0.0, 1.0)};
  return true;
}

/// Does the same as intersect_sheared(), but computes the corners in the ray's space itself.
template <class Point>
inline bool intersect_triangle(const TracedRay& ray, const Point& a, const Point& b, const Point& c,
                               Crossing& crossing) {
  return intersect_sheared(ray, a, b, c, sheared(ray, a), sheared(ray, b), sheared(ray, c),
                           crossing);
}

/// These functions return the box of a primitive, to which hits are confined (clip_to_box). A box
/// of a BVH must contain the boxes of all primitives in it. The box of a sphere is larger than the
/// sphere by more than the rounding of center and radius.
Box bounds(const Sphere& sphere);
Box bounds(const Quad& quad);
Box bounds(const Triangle& triangle);

/// Intersects the triangle. Like the next two functions, it returns true and sets `crossing` if the
/// primitive is hit.
bool intersect(const TracedRay& ray, const Triangle& triangle, Crossing& crossing);

/// Intersects the quad as two triangles that share the diagonal from `corner`.
bool intersect(const TracedRay& ray, const Quad& quad, Crossing& crossing);

/// Intersects a sphere (Haines, Günther, Akenine-Möller 2019, "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, ch. 7). The discriminant is computed from the vector
/// to the closest approach, and the roots are computed without cancellation.
///
/// `starts_on_it` is true if the ray starts on this sphere (Ray::from). Then the near root is no
/// hit, because it is the start of the ray or lies behind it. Origins lie 2^-40 off the surface
/// (geometry/surface.h), so rounding does not change whether the far root is a hit. The far root is
/// negative for a ray that leaves outwards, and at least 2^-20 of the radius for a ray that goes
/// inwards.
bool intersect(const TracedRay& ray, const Sphere& sphere, bool starts_on_it, Crossing& crossing);

}  // namespace bandsaw
