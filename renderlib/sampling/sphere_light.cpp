// Samples a sphere as seen from a point. If the point is outside, the cone that the sphere subtends
// is sampled. If the point is inside or very near, the area of the sphere is sampled.

#include "renderlib/sampling/sphere_light.h"

#include <cmath>

#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// At distances from the centre below this multiple of the radius, the cone is so wide that area
/// sampling is equally good. sample_sphere_light() and sphere_light_pdf() use the same criterion.
constexpr double kNear = 1 + 0x1p-20;

/// Returns true if a cone is sampled. `distance2` is the squared distance from the centre.
bool sees_cone(double distance2, double radius) {
  return distance2 > radius * radius * (kNear * kNear);
}

/// On the rim of the visible part, the normal is perpendicular to the direction from `point` to
/// `position`. After rounding, the cosine of the angle may be positive. Points with a cosine up to
/// this value count as visible.
constexpr double kRimCosine = 1e-6;

double area_pdf(double radius) { return kSpherePdf / (radius * radius); }

}  // namespace

std::optional<SphereSample> sample_sphere_light(const Vec3& center, double radius,
                                                const Vec3& point, double u, double v) {
  const Vec3 axis = center - point;
  const double distance2 = length_squared(axis);
  if (!sees_cone(distance2, radius)) {
    SphereSample sample;
    sample.normal = sample_sphere(u, v);
    sample.position = center + radius * sample.normal;
    sample.pdf = solid_angle_pdf(area_pdf(radius), point, sample.position, sample.normal);
    return std::isfinite(sample.pdf) && sample.pdf > 0 ? std::optional(sample) : std::nullopt;
  }
  const double distance = std::sqrt(distance2);
  const double sin2_max = radius * radius / distance2;
  const double spread = one_minus_cos_from_sin2(sin2_max);  // 1 - cos of the cone's half-angle
  const Vec3 local = sample_cone(u, v, spread);
  // Let d be the distance, r the radius, and theta the angle between the direction and the axis.
  // Let alpha be the angle between the direction from the centre to `point` and the normal where
  // the direction first meets the sphere. Then
  // cos alpha = (d sin^2 theta + cos theta sqrt(r^2 - d^2 sin^2 theta)) / r.
  const double sin2 = local.x * local.x + local.y * local.y;
  const double chord2 = std::max(0.0, 1 - sin2 / sin2_max);
  const double sin_max = radius / distance;
  const double cos_alpha = std::min(1.0, sin2 / sin_max + local.z * std::sqrt(chord2));
  // sin alpha = (d cos theta - sqrt(r^2 - d^2 sin^2 theta)) sin theta / r; `along` is
  // sin alpha / sin theta.
  const double along = local.z / sin_max - std::sqrt(chord2);
  const Basis frame = orthonormal_basis(axis / distance);
  SphereSample sample;
  sample.normal = normalize(frame.to_world({along * local.x, along * local.y, -cos_alpha}));
  sample.position = center + radius * sample.normal;
  sample.pdf = cone_pdf(spread);
  return sample;
}

double sphere_light_pdf(const Vec3& center, double radius, const Vec3& point, const Vec3& position,
                        const Vec3& normal) {
  const double distance2 = length_squared(center - point);
  if (sees_cone(distance2, radius)) {
    const Vec3 to_position = position - point;
    if (dot(normal, to_position) > kRimCosine * length(to_position)) {
      return 0;
    }
    return cone_pdf(one_minus_cos_from_sin2(radius * radius / distance2));
  }
  const double pdf = solid_angle_pdf(area_pdf(radius), point, position, normal);
  return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace bandsaw
