#pragma once

// Whether a mesh encloses something.

#include <cstddef>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// How many edges have no match: a closed mesh passes each edge as often in one direction as in the
/// other. Corners at equal positions are one, whatever their index. Indices MUST be valid,
/// positions finite.
std::size_t open_edges(const Mesh& mesh);

}  // namespace bandsaw
