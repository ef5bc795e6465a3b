#pragma once

// Validation of a description's geometry.

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Checks shapes, meshes, groups, frames and instances, like validate() (scene/validate.h).
/// `prefix` is prepended to the names of fields in errors; `materials` is the number of materials.
absl::Status check_geometry(const std::string& prefix, const Geometry& geometry,
                            std::size_t materials);

}  // namespace bandsaw
