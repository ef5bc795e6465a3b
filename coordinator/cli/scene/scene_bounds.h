#pragma once

#include "renderlib/geometry/box.h"
#include "renderlib/scene/description.h"

namespace bandsaw::coordinator {

/// Returns a bounding box of all geometry in world space. Moving objects are bounded at the times
/// when the shutter opens and closes only. Instances are bounded by the transformed boxes of their
/// meshes or groups.
Box bounds_of(const SceneDescription& scene);

}  // namespace bandsaw::coordinator
