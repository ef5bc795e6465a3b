#pragma once

// Validation of scene descriptions: every index, range and number. Descriptions from anywhere are
// judged here and nowhere else: by Scene::build, by the decoder of packages and by the importer.

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// Maximum magnitude of coordinates and lengths: beyond it their fourth powers would overflow a
/// double.
inline constexpr double kMaxCoordinate = 1e30;

/// Selects how vertices of meshes (positions, normals, uvs, colours) are judged.
enum class MeshVertices {
  kAny,     ///< any value: Scene::build removes triangles without a finite area
  kFinite,  ///< finite values only, as in scene packages
};

/// Returns INVALID_ARGUMENT with the field's path, the allowed range and the value:
/// "spheres[3].radius: must be > 0, is -1".
absl::Status validate(const SceneDescription& scene, MeshVertices vertices = MeshVertices::kAny);

}  // namespace bandsaw
