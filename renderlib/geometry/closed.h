#pragma once

// Check that a mesh is closed.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the number of edges without a match: a closed mesh contains each edge equally often in
/// both directions. Vertices at equal positions count as one, whatever their index. If the mesh
/// deforms, positions must be equal at both ends, so that the mesh is closed at all times. Indices
/// MUST be valid and positions finite.
std::size_t open_edges(const Mesh& mesh);

}  // namespace bandsaw
