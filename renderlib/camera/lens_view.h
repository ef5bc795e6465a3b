#pragma once

// The view from a point on a thin lens' plane of focus: the rays through the lens and that point.
// Each point of the lens sees the scene beyond the point in one direction, so directions away from
// the point correspond to points on the lens.

#include <optional>

#include "renderlib/math/cone.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

class LensView {
 public:
  /// Describes a round lens of `radius` > 0 around `middle`, perpendicular to the unit vector
  /// `forward`, focused at `distance` > 0 along it. `direction` leads from `middle` towards the
  /// point in focus; its component along `forward` is 1, i.e. it is in units of `distance`. Returns
  /// std::nullopt if the radius is not less than the distance to the point.
  static std::optional<LensView> make(const Vec3& middle, const Vec3& forward, double radius,
                                      double distance, const Vec3& direction);

  const Vec3& focus() const { return focus_; }
  /// Returns a cone that contains all directions in which rays continue beyond the point.
  const Cone& beyond() const { return beyond_; }

  /// Returns the point on the lens of the ray that continues in this unit direction; std::nullopt
  /// if the ray misses the lens.
  std::optional<Vec3> on_lens(const Vec3& direction) const;
  /// Returns the pdf by solid angle of the directions of rays from a uniformly sampled point on the
  /// lens; > 0 for the direction of such a ray. With the lens' area A and the angle a to its axis,
  /// it is distance^2 / (A cos^3 a).
  double pdf(const Vec3& direction) const;

 private:
  LensView() = default;

  Vec3 middle_;
  Vec3 forward_;
  Vec3 to_focus_;  ///< from `middle_`
  Vec3 focus_;
  double radius_ = 1;
  double distance_ = 1;
  Cone beyond_;
};

}  // namespace bandsaw
