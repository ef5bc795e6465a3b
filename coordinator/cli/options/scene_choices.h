#pragma once

#include <string>

namespace bandsaw::coordinator {

/// What somebody chose beside the scene; empty: as the scene says.
struct SceneChoices {
  std::string environment = {};  ///< an image that becomes the background; it may lie anywhere
  std::string camera = {};       ///< the name of one of its models' cameras
};

}  // namespace bandsaw::coordinator
