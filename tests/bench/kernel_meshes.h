#pragma once

// What the kernel is measured on.

#include <string>

#include "renderlib/geometry/shapes.h"

namespace bandsaw::bench {

/// A mesh by name (icosphere, needles, soup, room: the icosphere between six walls), or from a file
/// that assimp reads. Empty: there is no such.
Mesh bench_mesh(const std::string& name);

}  // namespace bandsaw::bench
