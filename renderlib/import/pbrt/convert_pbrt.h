#pragma once

// Converts scenes of pbrt-v4 to Bandsaw scene files.

#include "absl/status/statusor.h"
#include "renderlib/import/convert/converted_scene.h"
#include "renderlib/import/convert/foreign_scene.h"

namespace bandsaw {

/// Returns the scene as a Bandsaw scene file. Errors name file and line: "kitchen.pbrt:17: …".
/// INVALID_ARGUMENT: the scene is broken, or a value is out of its range. RESOURCE_EXHAUSTED: the
/// scene is too large, or its files or attributes are nested too deeply. NOT_FOUND,
/// PERMISSION_DENIED: a file that the scene includes cannot be read.
absl::StatusOr<ConvertedScene> convert_pbrt(const ForeignScene& from);

}  // namespace bandsaw
