#pragma once

// All rays of a thin lens through one point of its plane of focus: what is beyond that point is
// seen once from each point of the lens, so that a direction away from the point stands for one of
// them.

#include <optional>

#include "renderlib/math/cone.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

class LensView {
 public:
  /// A round lens of this radius > 0 around `middle`, across the unit vector `forward`, focused at
  /// `distance` > 0 along it; `way` leads from the middle to the point in focus and has the
  /// component 1 along `forward`, in units of the distance. Nothing where the lens is as wide as
  /// the point is far.
  static std::optional<LensView> make(const Vec3& middle, const Vec3& forward, double radius,
                                      double distance, const Vec3& way);

  const Vec3& focus() const { return focus_; }
  /// The directions in which rays go on from there, and some around these.
  const Cone& beyond() const { return beyond_; }

  /// Where the ray that goes on in this unit direction comes from the lens; nothing: it does not.
  std::optional<Vec3> on_lens(const Vec3& direction) const;
  /// The density of the unit directions of rays from everywhere on the lens evenly, by solid angle;
  /// for a direction of such a ray, > 0. (With the lens' area A and the angle a to its axis:
  /// distance^2 / (A cos^3 a).)
  double pdf(const Vec3& direction) const;

 private:
  LensView() = default;

  Vec3 middle_;
  Vec3 forward_;
  Vec3 to_focus_;  ///< from the middle
  Vec3 focus_;
  double radius_ = 1;
  double distance_ = 1;
  Cone beyond_;
};

}  // namespace bandsaw
