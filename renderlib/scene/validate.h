#pragma once

// Validation of scene descriptions: every index, range and number. All descriptions are validated
// here, whatever their source. Scene::build, the decoder of packages and the importer call
// validate().

#include <functional>

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// Maximum magnitude of coordinates and lengths. Their fourth powers stay far within the range of
/// double.
inline constexpr double kMaxCoordinate = 1e30;

/// Selects how vertices of meshes (positions, normals, uvs, colours) are judged.
enum class MeshVertices {
  kAny,     ///< any value: Scene::build removes triangles without a finite area
  kFinite,  ///< finite values only, as in scene packages
};

/// A function that returns true for a mesh that has been checked before and need not be checked
/// again.
using IsChecked = std::function<bool(const Mesh&)>;

/// Returns INVALID_ARGUMENT if something is wrong. The message has the field's path, the allowed
/// range and the value: "spheres[3].radius: must be > 0, is -1". If `checked` is empty, all meshes
/// are checked.
absl::Status validate(const SceneDescription& scene, MeshVertices vertices = MeshVertices::kAny,
                      const IsChecked& checked = {});

}  // namespace bandsaw
