#pragma once

// How the dashboard's scenes come to the farm: read by the confined importer, stored by the engine.

#include "coordinator/engine/engine.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// `engine` outlives it.
BringScene bring_scene(Engine& engine);

}  // namespace bandsaw::coordinator
