#pragma once

// A scene package to the farm: only the blobs that it lacks.

#include "absl/status/status.h"
#include "coordinator/cli/farm_client.h"
#include "coordinator/cli/import_process.h"
#include "coordinator/cli/progress_display.h"

namespace bandsaw::coordinator {

/// Afterwards the farm has the manifest and every blob that it names. Errors of the farm, and of
/// the package.
absl::Status upload(FarmClient& client, ImportedPackage& package, ProgressDisplay& display);

}  // namespace bandsaw::coordinator
