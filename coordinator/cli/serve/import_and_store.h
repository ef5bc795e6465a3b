#pragma once

// Imports scenes for the dashboard: read by the confined importer, stored by the engine.

#include "coordinator/engine/engine.h"
#include "coordinator/web/scenes.h"

namespace bandsaw::coordinator {

/// Returns the import function for the dashboard. `engine` MUST outlive it.
ImportScene import_and_store(Engine& engine);

}  // namespace bandsaw::coordinator
