// The directions in which the lens is seen from the point in focus lie within a cone, because the
// lens fits into a sphere of its radius. pdf() assumes that a ray starts at a uniformly chosen
// point of the lens and passes through the point in focus.

#include "renderlib/camera/lens_view.h"

#include <cmath>

#include "renderlib/math/constants.h"

namespace bandsaw {

std::optional<LensView> LensView::make(const Vec3& middle, const Vec3& forward, double radius,
                                       double distance, const Vec3& direction) {
  LensView view;
  view.middle_ = middle;
  view.forward_ = forward;
  view.to_focus_ = direction * distance;
  view.focus_ = middle + view.to_focus_;
  view.radius_ = radius;
  view.distance_ = distance;
  // The lens lies within a sphere of its radius.
  const double far = length(view.to_focus_);
  const double sine = radius / far;
  if (!(sine < 1)) {
    return std::nullopt;
  }
  view.beyond_ = {view.to_focus_ / far, sine, std::sqrt((1 - sine) * (1 + sine))};
  return view;
}

std::optional<Vec3> LensView::on_lens(const Vec3& direction) const {
  const double along = dot(direction, forward_);
  if (!(along > 0)) {
    return std::nullopt;
  }
  const Vec3 from = to_focus_ - direction * (distance_ / along);
  return length_squared(from) <= radius_ * radius_ ? std::optional(middle_ + from) : std::nullopt;
}

double LensView::pdf(const Vec3& direction) const {
  const double along = dot(direction, forward_);
  const double distance_in_radii = distance_ / radius_;
  return distance_in_radii * distance_in_radii / (kPi * along * along * along);
}

}  // namespace bandsaw
