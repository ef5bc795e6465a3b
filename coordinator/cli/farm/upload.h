#pragma once

// Uploads a scene package to the farm, and submits jobs. A package has a manifest and the blobs
// (parts of the scene) that the manifest names. A blob that the farm already has is not sent.

#include "absl/status/status.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/scene/import_process.h"

namespace bandsaw::coordinator {

/// Uploads the manifest and all blobs that the farm lacks; `display` shows the progress. Returns
/// errors of the farm and of the package.
absl::Status upload(FarmClient& client, ImportedPackage& package, ProgressDisplay& display);

/// Returns a request for a job of this package, with a new random request id.
farm::SubmitRequest request_for(const ImportedPackage& package, const RenderSettings& settings,
                                const StopRule& stop);

/// Uploads the package and submits the job. Errors: those of upload() and FarmClient::submit().
absl::StatusOr<JobId> send(FarmClient& client, ImportedPackage& package,
                           const farm::SubmitRequest& request, ProgressDisplay& display);

}  // namespace bandsaw::coordinator
