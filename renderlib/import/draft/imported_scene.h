#pragma once

// What an import makes.

#include "renderlib/package/package.h"

namespace bandsaw {

struct ImportedScene {
  SceneDescription scene;
  PackageInfo info;
};

}  // namespace bandsaw
