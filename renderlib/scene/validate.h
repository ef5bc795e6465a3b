#pragma once

// Whether a description is a scene: every index, range and number.

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// Coordinates and lengths beyond this are refused: their fourth powers would leave the range of
/// double.
inline constexpr double kMaxCoordinate = 1e30;

/// INVALID_ARGUMENT: the field's path, what is allowed and what was found: "spheres[3].radius: must
/// be > 0, is -1". Vertices of meshes may be anything: triangles without a finite area are dropped
/// when the scene is built.
absl::Status validate(const SceneDescription& scene);

}  // namespace bandsaw
