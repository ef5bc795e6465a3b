#pragma once

// The rays that pass through a thin lens and through one point on its plane of focus, the point in
// focus. Each point of the lens is the start of one of these rays, so the directions in which the
// rays continue beyond the point in focus correspond to points of the lens. Light sampling through
// the lens converts these directions to points of the lens (integrate/through_lens.h).

#include <optional>

#include "renderlib/math/cone.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

class LensView {
 public:
  /// Describes a round lens of `radius` > 0 around `middle`, perpendicular to the unit vector
  /// `forward`. The plane of focus is at `distance` > 0 from the lens. The point in focus is middle
  /// + distance * direction, so the component of `direction` along `forward` MUST be 1. Returns
  /// std::nullopt if the radius is not less than the distance from `middle` to the point in focus.
  static std::optional<LensView> make(const Vec3& middle, const Vec3& forward, double radius,
                                      double distance, const Vec3& direction);

  /// Returns the point in focus.
  const Vec3& focus() const { return focus_; }
  /// Returns a cone that contains all directions in which rays continue beyond the point in focus.
  const Cone& beyond() const { return beyond_; }

  /// Returns the point of the lens at which a ray must start to pass through the point in focus in
  /// the unit direction `direction`. Returns std::nullopt if the line of the ray misses the lens.
  std::optional<Vec3> on_lens(const Vec3& direction) const;
  /// Returns the pdf, by solid angle, of a ray's direction, if the ray starts at a uniformly
  /// sampled point of the lens and passes through the point in focus. `direction` MUST be the unit
  /// direction of such a ray. With the lens' area A and the angle a between `direction` and
  /// `forward`, the pdf is distance^2 / (A cos^3 a).
  double pdf(const Vec3& direction) const;

 private:
  LensView() = default;

  Vec3 middle_;
  Vec3 forward_;
  Vec3 to_focus_;  ///< from `middle_` to `focus_`
  Vec3 focus_;
  double radius_ = 1;
  double distance_ = 1;
  Cone beyond_;
};

}  // namespace bandsaw
