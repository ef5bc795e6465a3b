#pragma once

// The meshes of kernel_bench, which measures ray tracing.

#include <string>

#include "renderlib/geometry/shapes.h"

namespace bandsaw::bench {

/// Returns the mesh of this name, or the mesh of the file `name` that Assimp reads. The mesh is
/// empty if `name` is neither a name nor such a file. The names: icosphere (a round sphere),
/// needles (a sphere of long thin triangles), soup (small triangles at random places), room (a
/// rough sphere between six walls).
Mesh bench_mesh(const std::string& name);

}  // namespace bandsaw::bench
