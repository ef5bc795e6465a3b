#pragma once

// Check that a mesh is closed.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the number of edges without a match: a closed mesh contains each edge equally often in
/// both directions. Vertices at equal positions are identified, whatever their index; those of a
/// mesh that deforms if they are equal at both ends, so that it is closed at all times. Indices
/// MUST be valid and positions finite.
std::size_t open_edges(const Mesh& mesh);

}  // namespace bandsaw
