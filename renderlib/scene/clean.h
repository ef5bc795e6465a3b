#pragma once

// Cleans a valid geometry before the BVHs are built: removes primitives that no ray can hit, and
// replaces values that are not finite.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Removes quads and triangles, including those of meshes, whose area is zero or not finite (e.g.
/// because a vertex is not finite); the others keep their order. Normals, uvs and colours that are
/// not finite become zero. Returns the number of removed primitives; those of a mesh or group count
/// once per instance.
std::size_t clean(Geometry& geometry);

}  // namespace bandsaw
