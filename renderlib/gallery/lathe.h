#pragma once

// Surfaces of revolution: vases, lamps, pawns.

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// Returns a Wavefront OBJ of the profile rotated around the y axis. The x of a point is its
/// radius, >= 0, and its y is the height. A profile that goes up has its outside to the right.
/// Edges sharper than 40 degrees stay sharp, others have smooth normals; uv is (turn, share of the
/// profile's length). The profile has at least two points, no two consecutive ones equal. `around`,
/// >= 3, is the number of faces of a ring.
std::string lathe_obj(absl::Span<const Vec2> profile, int around);

/// Returns points of a smooth curve through `corners` (at least two), `steps` (>= 1) for each span
/// between two of them (Catmull and Rom 1974, "A class of local interpolating splines"); radii stay
/// >= 0.
std::vector<Vec2> smooth_profile(absl::Span<const Vec2> corners, int steps);

}  // namespace bandsaw::gallery
