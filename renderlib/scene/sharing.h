#pragma once

// Decides whether pixels of a scene may share paths (integrate/shared_paths.h).

#include "renderlib/light/lights.h"
#include "renderlib/scene/description.h"
#include "renderlib/scene/needs.h"

namespace bandsaw {

/// Returns true if area and delta lights emit all the light (the background is black), nothing
/// moves, there are no media, and every surface is either opaque or absent, for paths and shadow
/// rays alike. `needs` are those of the scene.
bool shares_paths(const SceneDescription& scene, const Lights& lights, const Needs& needs);

}  // namespace bandsaw
