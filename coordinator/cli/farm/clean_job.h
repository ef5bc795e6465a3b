#pragma once

// Removes the noise of a farm job's image, for `--denoise` of `submit` and `watch`. The filter
// needs guides: images of the albedo and of the shape of the surfaces, by which it finds edges.

#include "absl/status/statusor.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/progress_display.h"
#include "renderlib/denoise/denoise.h"

namespace bandsaw::coordinator {

/// Starts the jobs that clean_job() will wait for, so that the farm can render them before
/// clean_job() is called. Their priority is one higher than that of the image's job, but at most
/// kMaxPriority. `last` is the status of the image's job, which is finished. Errors: those of
/// clean_job().
absl::Status start_guides(FarmClient& client, const Progress& last);

/// Renders the guides on the farm, as jobs of their own (scheduler/api/clean_jobs.h), and then
/// filters `image`, the result of the job, on this machine. The clean image has the same bits as
/// that of `bandsaw render --denoise`. `last` is the status of the finished job; `display` shows
/// the progress of the guides. FAILED_PRECONDITION: the image cannot be cleaned (check_cleanable),
/// or the farm no longer has the scene. ABORTED: the job of a guide failed. Other errors: those of
/// follow_job.
absl::StatusOr<Denoised> clean_job(FarmClient& client, const Progress& last, const Image& image,
                                   Denoiser denoiser, ProgressDisplay& display);

}  // namespace bandsaw::coordinator
