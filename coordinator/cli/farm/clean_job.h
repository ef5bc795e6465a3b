#pragma once

// Removes the noise of a farm job's image.

#include "absl/status/statusor.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/progress_display.h"
#include "renderlib/denoise/denoise.h"

namespace bandsaw::coordinator {

/// Starts the jobs that clean_job() waits for, so that the farm renders them meanwhile. They are
/// rendered before other jobs of the image's priority. `last`: as there. Errors: those of
/// clean_job().
absl::Status start_guides(FarmClient& client, const Progress& last);

/// Renders the denoiser's guides on the farm, as jobs of their own (scheduler/api/clean_jobs.h),
/// and filters `image` on this machine, with the same bits as `bandsaw render --denoise`. `last` is
/// the status of the finished job. FAILED_PRECONDITION: the image cannot be cleaned
/// (check_cleanable), or the farm no longer has the scene. Other errors: those of follow_job;
/// ABORTED: one of these jobs failed.
absl::StatusOr<Denoised> clean_job(FarmClient& client, const Progress& last, const Image& image,
                                   Denoiser denoiser, ProgressDisplay& display);

}  // namespace bandsaw::coordinator
