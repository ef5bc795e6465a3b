#pragma once

#include <string>

namespace bandsaw::coordinator {

/// Choices of the user that override the scene; empty: as in the scene.
struct SceneChoices {
  std::string environment = {};  ///< image file that becomes the background; may be in any folder
  std::string camera = {};       ///< name of a camera of one of the scene's models
};

}  // namespace bandsaw::coordinator
