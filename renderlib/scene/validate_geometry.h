#pragma once

// The part of a description that is about what can be hit.

#include "absl/status/status.h"
#include "renderlib/scene/description.h"

namespace bandsaw {

/// As validate (scene/validate.h), of shapes, meshes, groups, frames and instances.
absl::Status check_geometry(const SceneDescription& scene);

}  // namespace bandsaw
