#pragma once

// Whether and where a ray meets a primitive: for each kind one function of (ray, primitive) in
// double, always the same operations. That, not real-number exactness, makes the closest hit
// independent of the tree that leads there.

#include <algorithm>
#include <cmath>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/geometry/traced_ray.h"

namespace bandsaw {

/// t in (0, t_max), and the coordinates that Hit describes.
struct Crossing {
  double t;
  double u;
  double v;
  const float* corners = nullptr;
};

/// a b - c d with the exact sign, within 1.5 units in the last place (Kahan). The sign of an edge
/// that two triangles share is therefore the same in both.
inline double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = std::fma(-c, d, cd);
  return std::fma(a, b, -cd) + error;
}

/// cross(a, b), each component within 1.5 units in the last place, also where products cancel.
inline Vec3 exact_cross(const Vec3& a, const Vec3& b) {
  return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
          difference_of_products(a.x, b.y, a.y, b.x)};
}

/// A point as the ray sees it: the ray is the z axis, its origin the origin.
struct Sheared {
  double x;
  double y;
  double z;
};

/// `Point` is an array of three numbers, float or double.
template <class Point>
[[gnu::always_inline]] inline Sheared sheared(const TracedRay& ray, const Point& p) {
  const auto kx = static_cast<std::size_t>(ray.kx);
  const auto ky = static_cast<std::size_t>(ray.ky);
  const auto kz = static_cast<std::size_t>(ray.kz);
  const double z = p[kz] - ray.origin[kz];
  return {(p[kx] - ray.origin[kx]) - ray.shear_x * z, (p[ky] - ray.origin[ky]) - ray.shear_y * z,
          z};
}

/// Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection", JCGT 2(1), both sides, edges
/// included: where triangles share an edge, a ray through it hits one of them at least. The corners
/// come as they are and sheared.
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

template <class Point>
inline bool intersect_triangle(const TracedRay& ray, const Point& a, const Point& b, const Point& c,
                               Crossing& crossing) {
  return intersect_sheared(ray, a, b, c, sheared(ray, a), sheared(ray, b), sheared(ray, c),
                           crossing);
}

/// The boxes that hits are confined to (clip_to_box); what a tree's boxes must hold. A sphere's is
/// a little larger than the sphere, by more than the rounding of center and radius.
Box bounds(const Sphere& sphere);
Box bounds(const Quad& quad);
Box bounds(const Triangle& triangle);

bool intersect(const TracedRay& ray, const Triangle& triangle, Crossing& crossing);

/// As two triangles that share the diagonal from `corner`.
bool intersect(const TracedRay& ray, const Quad& quad, Crossing& crossing);

/// Haines, Günther, Akenine-Möller 2019, "Precision Improvements for Ray/Sphere Intersection", Ray
/// Tracing Gems, ch. 7: the discriminant from the vector to the closest approach, the roots without
/// cancellation. `starts_on_it`: the ray starts on this very sphere (Ray::from); then the near
/// root, which is the start or lies behind it, is no hit. Origins lie 2^-40 off the surface
/// (geometry/surface.h), so the far root is clear of rounding as well: it is negative for a ray
/// that leaves outwards, and at least 2^-20 of the radius for one that goes inwards.
bool intersect(const TracedRay& ray, const Sphere& sphere, bool starts_on_it, Crossing& crossing);

}  // namespace bandsaw
