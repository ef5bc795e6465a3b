#pragma once

// The part of a description's check that is about what can be hit.

#include <cstddef>
#include <string>

#include "absl/status/status.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// As validate (scene/validate.h), of shapes, meshes, groups, frames and instances. Errors name
/// fields from `prefix` on; there are so many materials.
absl::Status check_geometry(const std::string& prefix, const Geometry& geometry,
                            std::size_t materials);

}  // namespace bandsaw
