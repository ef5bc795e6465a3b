#pragma once

// Triangle meshes: float32 positions in a space of their own. Instances (geometry/shapes.h) place
// them in the world.

#include <array>
#include <cstdint>
#include <vector>

namespace bandsaw {

struct Mesh {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into positions
  std::vector<std::array<float, 3>> normals;            ///< empty, or one per position
  std::vector<std::array<float, 2>> uvs;                ///< empty, or one per position
  std::vector<std::array<float, 2>> uvs2 = {};          ///< second set: empty, or one per position
  std::vector<std::array<float, 3>> colors = {};  ///< linear RGB >= 0: empty, or one per position
  /// Empty unless the mesh deforms during the shutter interval (geometry/deforming_mesh.h). Then
  /// these are the vertex positions at the end of the interval, one for each element of
  /// `positions`, which are the vertex positions at its beginning.
  std::vector<std::array<float, 3>> positions_at_close = {};
  /// Normals at the end of the shutter interval, one per position. If empty, the normals do not
  /// change.
  std::vector<std::array<float, 3>> normals_at_close = {};
};

}  // namespace bandsaw
