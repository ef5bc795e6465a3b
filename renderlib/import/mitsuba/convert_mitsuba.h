#pragma once

// Converts scenes of Mitsuba. Versions 2 and 3 are supported. Version 0.x is supported where its
// names differ from the later names only in spelling.

#include "absl/status/statusor.h"
#include "renderlib/import/convert/converted_scene.h"
#include "renderlib/import/convert/foreign_scene.h"

namespace bandsaw {

/// Returns the scene as a Bandsaw scene file. Errors name file and line: "kitchen.xml:17: …".
/// INVALID_ARGUMENT: the scene is broken or exceeds a bound. NOT_FOUND, PERMISSION_DENIED: a
/// file that the scene includes cannot be read.
absl::StatusOr<ConvertedScene> convert_mitsuba(const ForeignScene& from);

}  // namespace bandsaw
