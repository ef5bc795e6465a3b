#pragma once

// The meshes of kernel_bench, which measures ray tracing.

#include <string>

#include "renderlib/geometry/shapes.h"

namespace bandsaw::bench {

/// Returns a mesh by name, or from a file that Assimp reads; empty if there is none. The names:
/// icosphere (a round sphere), needles (a sphere of long thin triangles), soup (small triangles at
/// random places), room (a rough sphere between six walls).
Mesh bench_mesh(const std::string& name);

}  // namespace bandsaw::bench
