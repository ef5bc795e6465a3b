#pragma once

// Takes out of a valid geometry what no ray can hit, and mends what would spread: before the trees
// are built.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Drops quads and triangles without area and mesh triangles that touch a vertex that is not
/// finite; the rest keep their order. Normals and uvs that are not finite become zero. Returns how
/// many primitives were dropped, those of a mesh once for each time it is placed.
std::size_t clean(Geometry& geometry);

}  // namespace bandsaw
