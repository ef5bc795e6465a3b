#pragma once

// The result of an import: the scene's description, and the data that a scene package holds besides
// it (name, image size, warnings). bandsaw-import encodes both as a package.

#include "renderlib/package/package.h"

namespace bandsaw {

struct ImportedScene {
  SceneDescription scene;
  PackageInfo info;
};

}  // namespace bandsaw
