#pragma once

// What foreign meshes get wrong and can be put right without a guess at what was meant.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Leaves out the vertices that no triangle uses, if one of them is not finite; a package holds
/// finite vertices only.
void drop_unused_vertices(Mesh& mesh);

/// A normal that is zero or not finite becomes the area-weighted mean of the normals of its
/// triangles. How many did.
std::size_t mend_normals(Mesh& mesh);

/// A uv that is not finite becomes (0, 0). How many did.
std::size_t mend_uvs(Mesh& mesh);

}  // namespace bandsaw
