#pragma once

// Affine maps of space in double: p -> M p + t.

#include <array>
#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

struct Transform {
  /// Rows of the 3 x 4 matrix (M | t).
  std::array<std::array<double, 4>, 3> m = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  Vec3 point(const Vec3& p) const;      ///< returns M p + t
  Vec3 direction(const Vec3& d) const;  ///< returns M d
  friend bool operator==(const Transform&, const Transform&) = default;
};

/// Returns the composition that applies b, then a.
Transform operator*(const Transform& a, const Transform& b);

Transform translation(const Vec3& by);
/// Returns the map that scales x, y and z by the components of `by`.
Transform scaling(const Vec3& by);
/// Returns the rotation by an angle in degrees about `axis` (not zero), counter-clockwise if the
/// axis points to the viewer.
Transform rotation(const Vec3& axis, double degrees);

/// Returns the determinant of M.
double determinant(const Transform& t);

/// Returns the inverse map. Returns std::nullopt if the map is singular to working precision: it
/// has an element that is not finite, determinant 0, or a condition number above 1e12.
std::optional<Transform> inverse(const Transform& t);

/// Transforms a normal by a map whose inverse is `inverse`. The result is the transpose of the
/// linear part of `inverse` times n. In general it is not a unit vector.
Vec3 normal_to_world(const Transform& inverse, const Vec3& n);

}  // namespace bandsaw
