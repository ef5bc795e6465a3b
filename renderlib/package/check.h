#pragma once

// What every scene that travels in a package holds to.

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// Indices, counts, ranges and finiteness of a whole description, naming fields as
/// proto/package.proto does. INVALID_ARGUMENT: "scene package: mesh[2].indices[7]: is 40, the mesh
/// has 40 vertices".
absl::Status check_description(const SceneDescription& scene);

/// The part of it that is about textures and materials alone.
absl::Status check_materials(const SceneDescription& scene);

}  // namespace bandsaw
