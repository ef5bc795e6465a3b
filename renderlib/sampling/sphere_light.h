#pragma once

// The directions in which a point sees a sphere, uniform in solid angle: a cone from outside. A
// point on or inside the sphere sees it all around, where the area of the sphere is sampled
// instead.

#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

struct SphereSample {
  Vec3 position;   ///< on the sphere, on the side that faces the point
  Vec3 normal;     ///< unit, outward
  double pdf = 0;  ///< of the direction from the point to `position`, by solid angle
};

/// Nothing when the sample has no density as a direction (a point on the sphere that looks along
/// it).
std::optional<SphereSample> sample_sphere_light(const Vec3& center, double radius,
                                                const Vec3& point, double u, double v);

/// The density by solid angle with which sample_sphere_light makes the direction from `point` to
/// `position`, which is a point of the sphere with outward unit normal `normal`: 0 on the side that
/// only those see who look through the sphere.
double sphere_light_pdf(const Vec3& center, double radius, const Vec3& point, const Vec3& position,
                        const Vec3& normal);

}  // namespace bandsaw
