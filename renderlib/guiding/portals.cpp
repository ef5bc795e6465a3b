// Portals are rectangular openings through which the background lights a room. This file tests
// whether a ray passes through a portal, samples directions through the portals, and returns the
// pdf of a direction.

#include "renderlib/guiding/portals.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {

bool Portal::passes(const Vec3& from, const Vec3& direction) const {
  const Vec3 normal = cross(u, v);
  const Vec3 to = corner - from;
  const double distance = dot(to, normal) / dot(direction, normal);
  if (!(distance > 0) || !std::isfinite(distance)) {
    return false;
  }
  const Vec3 at = direction * distance - to;
  const double a = dot(at, u);
  const double b = dot(at, v);
  return a >= 0 && a <= length_squared(u) && b >= 0 && b <= length_squared(v);
}

Portals::View Portals::view_from(const Vec3& from) const {
  View view;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    const Portal& portal = portals_[i];
    view.rectangles[i] = SphericalRectangle::seen_from(from, portal.corner, portal.u, portal.v);
    view.solid_angle += view.rectangles[i] ? view.rectangles[i]->solid_angle() : 0;
  }
  return view;
}

std::uint32_t Portals::passed(const View& view, const Vec3& from, const Vec3& direction) const {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    count += view.rectangles[i] && portals_[i].passes(from, direction) ? 1 : 0;
  }
  return count;
}

std::optional<Portals::Sample> Portals::sample(const Vec3& from, double choice, double u,
                                               double v) const {
  const View view = view_from(from);
  if (!(view.solid_angle > 0)) {
    return std::nullopt;
  }
  std::size_t chosen = portals_.size();
  double left = choice * view.solid_angle;
  for (std::size_t i = 0; i < portals_.size(); ++i) {
    if (view.rectangles[i]) {
      // If rounding keeps `left` >= 0 to the end, the last portal that is seen stays chosen.
      chosen = i;
      left -= view.rectangles[i]->solid_angle();
      if (left < 0) {
        break;
      }
    }
  }
  const Portal& portal = portals_[chosen];
  const Vec2 at = view.rectangles[chosen]->sample(u, v);
  const Vec3 direction = normalize(portal.corner + portal.u * at.x + portal.v * at.y - from);
  // The pdf is the number of portals through which the direction passes, divided by the solid angle
  // of all portals. The direction was chosen within a portal, so the number is at least 1. Because
  // of rounding, passed() may still return 0 at the border of the chosen portal.
  const std::uint32_t count = std::max(passed(view, from, direction), 1u);
  return Sample{direction, count / view.solid_angle};
}

double Portals::pdf(const Vec3& from, const Vec3& direction) const {
  const bool any = std::any_of(portals_.begin(), portals_.end(), [&](const Portal& portal) {
    return portal.passes(from, direction);
  });
  if (!any) {
    return 0;
  }
  const View view = view_from(from);
  return view.solid_angle > 0 ? passed(view, from, direction) / view.solid_angle : 0;
}

}  // namespace bandsaw
