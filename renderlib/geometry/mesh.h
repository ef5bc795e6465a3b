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
  /// Vertex positions at the end of the shutter interval, if the mesh deforms during the interval
  /// (geometry/deforming_mesh.h); otherwise empty. `positions` holds the positions at the beginning
  /// of the interval, in the same order.
  std::vector<std::array<float, 3>> positions_at_close = {};
  /// Normals at the end of the shutter interval, one per position. If empty, the normals do not
  /// change.
  std::vector<std::array<float, 3>> normals_at_close = {};
};

}  // namespace bandsaw
