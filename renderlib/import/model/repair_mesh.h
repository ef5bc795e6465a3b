#pragma once

// Repairs those defects of an imported mesh whose repair needs no guess at what was meant.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// If any vertex of the mesh is not finite, removes all vertices that no triangle uses. The reason
/// is that a package, the form in which a scene is sent, may contain only finite vertices.
void drop_unused_vertices(Mesh& mesh);

/// Replaces each normal that is zero or not finite by the area-weighted mean of the normals of its
/// triangles, or by (0, 1, 0) if this mean is zero. If the mesh deforms, the normals at both ends
/// of the shutter interval are repaired. Returns the number of replaced normals.
std::size_t repair_normals(Mesh& mesh);

/// Replaces each uv that is not finite by (0, 0). Returns the number of replaced uvs.
std::size_t repair_uvs(Mesh& mesh);

}  // namespace bandsaw
