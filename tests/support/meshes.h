#pragma once

// Meshes that several tests trace.

#include <cstdint>

#include "renderlib/geometry/shapes.h"
#include "tests/support/random.h"

namespace bandsaw::test {

/// The unit sphere from an icosahedron whose triangles are split in four `levels` times: 20 *
/// 4^levels triangles, closed, normals outwards. Vertices are shared.
Mesh icosphere(int levels);

/// A sphere of latitudes and longitudes with shared vertices, its radii drawn from [1, spread]:
/// spread 1 is round, 6 is spikes. Closed; slices much finer than stacks make needles.
Mesh rough_sphere(int slices, int stacks, double spread, std::uint64_t seed);

/// `count` triangles of edges up to `size` at random places of the cube [-1, 1]^3.
Mesh triangle_soup(int count, double size, std::uint64_t seed);

/// Everything moved by `by`, rounded to float.
Mesh moved(Mesh mesh, const Vec3& by);
Mesh scaled(Mesh mesh, double by);

/// A unit vector, uniform over directions.
Vec3 random_direction(Random& random);
/// A point in the cube [-1, 1]^3.
Vec3 random_point(Random& random);

}  // namespace bandsaw::test
