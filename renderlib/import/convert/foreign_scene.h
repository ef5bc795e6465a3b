#pragma once

// The input of the converters of other renderers' scenes (convert_pbrt, convert_mitsuba).

#include <map>
#include <string>

#include "renderlib/import/files/scene_folder.h"

namespace bandsaw {

/// A scene file of another renderer. A converter reads this file and the files that it names, which
/// must lie below `folder` (SceneFolder::resolve). The result is a ConvertedScene
/// (converted_scene.h).
struct ForeignScene {
  std::string path;  ///< real path of the file, in `folder`
  std::string name;  ///< its name in errors and warnings: "kitchen.pbrt"
  const SceneFolder& folder;
  /// Values of the scene's parameters (`-D name=value`), for Mitsuba. A converter without
  /// parameters refuses a map that is not empty.
  std::map<std::string, std::string> parameters = {};
};

}  // namespace bandsaw
