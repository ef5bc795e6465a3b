#pragma once

// A scene package to the farm, only the blobs that it lacks, and a job of it.

#include "absl/status/status.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/scene/import_process.h"

namespace bandsaw::coordinator {

/// Afterwards the farm has the manifest and every blob that it names. Errors of the farm, and of
/// the package.
absl::Status upload(FarmClient& client, ImportedPackage& package, ProgressDisplay& display);

/// A job of this package, with a new request id.
farm::SubmitRequest request_for(const ImportedPackage& package, const RenderSettings& settings,
                                const StopRule& stop);

/// Uploads the package and submits the job. Errors of both.
absl::StatusOr<JobId> send(FarmClient& client, ImportedPackage& package,
                           const farm::SubmitRequest& request, ProgressDisplay& display);

}  // namespace bandsaw::coordinator
