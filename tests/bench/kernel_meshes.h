#pragma once

// Meshes for measuring ray tracing.

#include <string>

#include "renderlib/geometry/shapes.h"

namespace bandsaw::bench {

/// Returns a mesh by name (icosphere, needles, soup, room: the icosphere between six walls), or
/// from a file that Assimp reads; empty if there is none.
Mesh bench_mesh(const std::string& name);

}  // namespace bandsaw::bench
