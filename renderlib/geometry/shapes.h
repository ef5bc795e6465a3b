#pragma once

// What can be hit, as plain values. Meshes keep float32 positions in their own space; placements
// stay double and are never baked into the vertices.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

struct Sphere {
  Vec3 center;
  double radius = 1;  ///< > 0
  MaterialId material{};
};

/// The parallelogram corner + a u + b v, (a, b) in [0, 1]^2. Normal u x v.
struct Quad {
  Vec3 corner;
  Vec3 u;
  Vec3 v;
  MaterialId material{};
};

/// Normal (b - a) x (c - a).
struct Triangle {
  Vec3 a;
  Vec3 b;
  Vec3 c;
  MaterialId material{};
};

struct Mesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
  std::vector<std::array<float, 3>> normals;            ///< empty, or one a position
  std::vector<std::array<float, 2>> uvs;                ///< empty, or one a position
  std::vector<std::array<float, 2>> uvs2 = {};  ///< the second set: empty, or one a position
  std::vector<std::array<float, 3>> colors = {};        ///< linear RGB >= 0: empty, or one a position
};

/// One placement of a mesh.
struct Instance {
  MeshId mesh{};
  MaterialId material{};
  Transform to_world;  ///< regular (math/transform.h, inverse)
};

/// Everything that can be hit. In a hit, `instance` 0 is the loose shapes, whose `primitive` counts
/// the spheres, then the quads, then the triangles; `instance` i + 1 is instances[i], whose
/// `primitive` is the triangle of its mesh.
struct Geometry {
  std::vector<Sphere> spheres;
  std::vector<Quad> quads;
  std::vector<Triangle> triangles;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
};

}  // namespace bandsaw
