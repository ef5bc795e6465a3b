#pragma once

#include "renderlib/geometry/box.h"
#include "renderlib/scene/description.h"

namespace bandsaw::coordinator {

/// The box around all that can be hit, in the world; of what moves, where it is when the shutter
/// opens and closes. Instances count as the boxes of what they place.
Box bounds_of(const SceneDescription& scene);

}  // namespace bandsaw::coordinator
