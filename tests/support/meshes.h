#pragma once

// Meshes used by several tests.

#include <cstdint>

#include "renderlib/geometry/shapes.h"
#include "tests/support/random.h"

namespace bandsaw::test {

/// A unit sphere from an icosahedron whose triangles are subdivided `levels` times: 20 * 4^levels
/// triangles, closed, normals outwards, shared vertices.
Mesh icosphere(int levels);

/// A closed sphere of latitudes and longitudes around the origin, with shared vertices. Each vertex
/// has a random radius in [1, spread]: spread 1 is round, 6 gives spikes. Many more slices than
/// stacks give needle-shaped triangles.
Mesh rough_sphere(int slices, int stacks, double spread, std::uint64_t seed);

/// `count` triangles around random places of the cube [-1, 1]^3. The corners of a triangle lie
/// within a cube whose edges have the length `size`.
Mesh triangle_soup(int count, double size, std::uint64_t seed);

/// `moved` adds `by` to all vertices, and `scaled` multiplies them by `by`. Both compute in double
/// and round the results to float.
Mesh moved(Mesh mesh, const Vec3& by);
Mesh scaled(Mesh mesh, double by);

/// A unit vector, uniform over directions.
Vec3 random_direction(Random& random);
/// A point in the cube [-1, 1]^3.
Vec3 random_point(Random& random);

}  // namespace bandsaw::test
