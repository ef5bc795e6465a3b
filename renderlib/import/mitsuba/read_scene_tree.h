#pragma once

// Reads the XML files of a Mitsuba scene.

#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/convert/foreign_scene.h"
#include "renderlib/import/mitsuba/files.h"
#include "renderlib/import/mitsuba/scene_tree.h"

namespace bandsaw::mitsuba {

/// Reads the XML file of a Mitsuba scene, and the files that it includes, as a tree of objects.
/// <path> elements add folders to `files`. Names of version 0.x ("toWorld") are changed to the
/// spelling of later versions ("to_world"). INVALID_ARGUMENT with file and line: the XML is broken,
/// a parameter or reference is undefined, a number is not finite, an object refers to itself, or a
/// bound is exceeded (size, nesting, includes).
absl::StatusOr<SceneTree> read_scene_tree(const ForeignScene& from, Files& files);

}  // namespace bandsaw::mitsuba
