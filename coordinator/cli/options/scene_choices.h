#pragma once

#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Choices of the user that override the scene; empty: as in the scene.
struct SceneChoices {
  std::string environment = {};  ///< image file that becomes the background; may be in any folder
  std::string camera = {};       ///< name of a camera of one of the scene's models
  /// Parameters of a Mitsuba scene, each "name=value".
  std::vector<std::string> parameters = {};
  bool strict = false;  ///< a warning of the import is an error
  /// In a zip file, the name of the scene. Empty: the only one (scene/unpacked_scene.h).
  std::string inside = {};
};

}  // namespace bandsaw::coordinator
