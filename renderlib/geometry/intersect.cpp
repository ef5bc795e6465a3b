// The intersection tests in double, which decide every hit. A quad is two triangles that share the
// diagonal. The formulas for spheres avoid cancellation.

#include "renderlib/geometry/intersect.h"

#include <array>

namespace bandsaw {
namespace {

using Point = std::array<double, 3>;

Point point(const Vec3& p) { return {p.x, p.y, p.z}; }

}  // namespace

Box bounds(const Sphere& sphere) {
  // 2^-44 is 2^9 units of rounding (2^-53), far more than the rounding errors of the test.
  const double reach = sphere.radius + 0x1p-44 * (sphere.radius + max_abs(sphere.center));
  const Vec3 half = {reach, reach, reach};
  return {sphere.center - half, sphere.center + half};
}

Box bounds(const Quad& quad) {
  Box box;
  box.add(quad.corner);
  box.add(quad.corner + quad.u);
  box.add(quad.corner + quad.v);
  box.add(quad.corner + quad.u + quad.v);
  return box;
}

Box bounds(const Triangle& triangle) {
  Box box;
  box.add(triangle.a);
  box.add(triangle.b);
  box.add(triangle.c);
  return box;
}

bool intersect(const TracedRay& ray, const Triangle& triangle, Crossing& crossing) {
  return intersect_triangle(ray, point(triangle.a), point(triangle.b), point(triangle.c), crossing);
}

bool intersect(const TracedRay& ray, const Quad& quad, Crossing& crossing) {
  const Vec3 along_u = quad.corner + quad.u;
  const Point corner = point(quad.corner);
  const Point opposite = point(along_u + quad.v);
  const Point to_u = point(along_u);
  const Point to_v = point(quad.corner + quad.v);
  const Sheared at_corner = sheared(ray, corner);
  const Sheared at_opposite = sheared(ray, opposite);
  Crossing first{};
  Crossing second{};
  const bool hit_first = intersect_sheared(ray, corner, to_u, opposite, at_corner,
                                           sheared(ray, to_u), at_opposite, first);
  const bool hit_second = intersect_sheared(ray, corner, opposite, to_v, at_corner, at_opposite,
                                            sheared(ray, to_v), second);
  // On the diagonal both triangles are hit. The nearer hit is used, or that of the first triangle
  // if t is equal. The opposite corner has u = v = 1, so its weight counts for both coordinates.
  if (hit_first && (!hit_second || first.t <= second.t)) {
    crossing = {first.t, std::min(1.0, first.u + first.v), first.v};
    return true;
  }
  if (hit_second) {
    crossing = {second.t, second.u, std::min(1.0, second.u + second.v)};
  }
  return hit_second;
}

// Let f be the ray's origin relative to the centre. The function solves a t^2 - 2 b t + c = 0,
// where c = |f|^2 - r^2 is the variable `product`. The discriminant (b^2 - a c) / a is computed as
// r^2 minus the squared distance of the centre from the ray's line, because this form does not
// cancel.
bool intersect(const TracedRay& ray, const Sphere& sphere, bool starts_on_it, Crossing& crossing) {
  const Vec3 f = Vec3{ray.origin[0], ray.origin[1], ray.origin[2]} - sphere.center;
  const Vec3 d = {ray.direction[0], ray.direction[1], ray.direction[2]};
  const double r2 = sphere.radius * sphere.radius;
  const double a = length_squared(d);
  const double b = -dot(f, d);
  const double discriminant = r2 - length_squared(f + (b / a) * d);
  if (!(discriminant >= 0)) {
    return false;
  }
  const double root = std::sqrt(a * discriminant);
  const double q = b < 0 ? b - root : b + root;
  const double distance = length(f);
  const double product = (distance - sphere.radius) * (distance + sphere.radius);
  // The roots are product / q and q / a. The near root is product / q if b >= 0, otherwise q / a.
  const bool near_by_product = !(b < 0);
  double t = starts_on_it ? -1 : near_by_product ? product / q : q / a;
  if (!(t > 0)) {
    t = near_by_product ? q / a : product / q;
  }
  if (!(t > 0)) {
    return false;
  }
  const Box box = bounds(sphere);
  const double lo[3] = {box.lo.x, box.lo.y, box.lo.z};
  const double hi[3] = {box.hi.x, box.hi.y, box.hi.z};
  if (!clip_to_box(ray, lo, hi, t) || !(t < ray.t_max)) {
    return false;
  }
  crossing = {t, 0, 0};
  return true;
}

}  // namespace bandsaw
