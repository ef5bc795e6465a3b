#pragma once

// Samples a sphere as seen from a point. If the point is outside, the directions form a cone, which
// is sampled uniformly in solid angle. If the point is inside the sphere, on it or very near it,
// the area is sampled uniformly instead.

#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

struct SphereSample {
  Vec3 position;   ///< on the sphere; on the side that faces the point if a cone is sampled
  Vec3 normal;     ///< unit, outward
  double pdf = 0;  ///< pdf of the direction from the point to `position`, by solid angle
};

/// Samples a point of the sphere as seen from `point`. Returns std::nullopt if the sampled
/// direction has no finite pdf. This happens if the sampled point is `point` itself, or if the
/// direction is tangent to the sphere.
std::optional<SphereSample> sample_sphere_light(const Vec3& center, double radius,
                                                const Vec3& point, double u, double v);

/// Returns the pdf, by solid angle, with which `sample_sphere_light` samples the direction from
/// `point` to `position`, a point of the sphere with outward unit normal `normal`. If a cone is
/// sampled, the pdf is 0 on the far side, which can only be seen through the sphere.
double sphere_light_pdf(const Vec3& center, double radius, const Vec3& point, const Vec3& position,
                        const Vec3& normal);

}  // namespace bandsaw
