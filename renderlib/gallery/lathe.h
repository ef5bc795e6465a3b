#pragma once

// Turned things: vases, lamps, pawns.

#include <string>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// A Wavefront OBJ of the profile turned around the y axis: x of a point is its radius, >= 0, y its
/// height. A profile that goes up has its outside to the right. Edges sharper than 40 degrees stay
/// edges, others are smooth by their normals; uv is (turn, share of the profile's length).
/// At least two points, no two in a row alike; around >= 3.
std::string lathe_obj(absl::Span<const Vec2> profile, int around);

/// The points of a smooth curve through `corners`, `steps` to each span (Catmull and Rom 1974, "A
/// class of local interpolating splines"); radii stay >= 0.
std::vector<Vec2> smooth_profile(absl::Span<const Vec2> corners, int steps);

}  // namespace bandsaw::gallery
