#pragma once

// Triangle meshes as binary PLY. In this form the converters of other renderers' scenes pass meshes
// to the importer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bandsaw {

/// A mesh. Each list of numbers per vertex has the length of `positions` or is empty. v = 0 is the
/// bottom row of an image.
struct PlyMesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;
  std::vector<std::array<float, 2>> uvs;
  std::vector<std::array<float, 3>> colors;  ///< linear RGB
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Numbers that belong to each vertex or to each triangle.
struct MeshAttribute {
  std::string name;  ///< "vertex_color", "face_weight"
  bool per_face = false;
  std::size_t channels = 1;   ///< 1 or 3
  std::vector<float> values;  ///< `channels` numbers for each vertex or triangle
};

/// Returns the mesh as binary little-endian PLY. `mesh` MUST have a triangle, and each index MUST
/// be that of a vertex.
std::string write_ply(const PlyMesh& mesh);

}  // namespace bandsaw
