#pragma once

// Whether the pixels of a scene may share what their paths find (integrate/shared_paths.h).

#include "renderlib/light/lights.h"
#include "renderlib/scene/description.h"
#include "renderlib/scene/needs.h"

namespace bandsaw {

/// Where lamps give all the light, so that paths stay among the surfaces, nothing moves, and what
/// is between two points hides one from the other or is not there. `needs`: the scene's own.
bool shares_paths(const SceneDescription& scene, const Lights& lights, const Needs& needs);

}  // namespace bandsaw
