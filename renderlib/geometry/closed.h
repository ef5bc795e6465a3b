#pragma once

// Check that a mesh is closed. A mesh that bounds a medium must be closed (scene/media.cpp).

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the number of edges that the triangles do not pass equally often in both directions; it
/// is 0 for a closed mesh. Vertices at equal positions count as one, whatever their index. If the
/// mesh deforms, vertices count as one only if their positions are equal at both ends of the
/// shutter interval, so that the result holds at all times. Indices MUST be valid and positions
/// finite.
std::size_t open_edges(const Mesh& mesh);

}  // namespace bandsaw
