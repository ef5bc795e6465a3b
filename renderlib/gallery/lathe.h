#pragma once

// Surfaces of revolution: vases, lamps, pawns.

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// Returns a Wavefront OBJ of the profile rotated around the y axis. The x of a point is its
/// radius, >= 0, and its y is the height. The outside of the surface is to the right of the
/// direction of the profile, if the radius is drawn to the right and the height upwards.
/// Edges sharper than 40 degrees stay sharp, and other edges have smooth normals. uv is (turn,
/// share of the profile's length). The profile MUST have at least two points, and consecutive
/// points MUST differ. `around`, >= 3, is the number of faces of a ring.
std::string lathe_obj(absl::Span<const Vec2> profile, int around);

/// Returns points of a smooth curve through `corners`, at least two (Catmull and Rom 1974, "A class
/// of local interpolating splines"). Each span between two consecutive corners gets `steps` points,
/// >= 1. Negative radii are replaced by 0.
std::vector<Vec2> smooth_profile(absl::Span<const Vec2> corners, int steps);

}  // namespace bandsaw::gallery
