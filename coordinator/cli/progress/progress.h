#pragma once

// The state of a render in progress, on this machine or on a farm. The files of this folder display
// it as text, as JSON and as a picture.

#include <string>

#include "coordinator/convert/farm_messages.h"
#include "coordinator/scheduler/api/job_view.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// A farm's job, or a render on this machine, which has the id 0 and no workers.
struct Progress {
  JobView job;
  /// Pixel and sample of the first sample that was left out (NaN, infinite or negative); empty:
  /// none.
  std::string bad_sample_at;
  int threads = 0;  ///< threads of a render on this machine; 0: a farm's job
  /// Upper bound of the error of the image without noise (--denoise), a fraction; negative:
  /// unknown, or the noise is not removed. job.error is that of the image as rendered.
  double clean_error = -1;
};

/// Converts the status of a job that the coordinator has sent. Values for which the message has no
/// field, such as `clean_error`, keep their default.
inline Progress progress_of(const farm::JobStatus& status) {
  return {.job = job_view_of(status), .bad_sample_at = status.bad_sample_at()};
}

}  // namespace bandsaw::coordinator
