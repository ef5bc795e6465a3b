#pragma once

// Validation of scene descriptions: every index, range and number.

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// Maximum magnitude of coordinates and lengths: beyond it their fourth powers would overflow a
/// double.
inline constexpr double kMaxCoordinate = 1e30;

/// Returns INVALID_ARGUMENT with the field's path, the allowed range and the value:
/// "spheres[3].radius: must be > 0, is -1". Vertices of meshes may have any value: triangles
/// without a finite area are removed when the scene is built.
absl::Status validate(const SceneDescription& scene);

}  // namespace bandsaw
