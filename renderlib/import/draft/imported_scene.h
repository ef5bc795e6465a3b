#pragma once

// Result of an import.

#include "renderlib/package/package.h"

namespace bandsaw {

struct ImportedScene {
  SceneDescription scene;
  PackageInfo info;
};

}  // namespace bandsaw
