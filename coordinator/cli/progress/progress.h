#pragma once

// State of a render in progress, local or on a farm: the model for the text and JSON output.

#include <string>

#include "coordinator/convert/farm_messages.h"
#include "coordinator/scheduler/api/job_view.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// A farm's job, or a local render (id 0, no workers).
struct Progress {
  JobView job;
  std::string bad_sample_at;  ///< pixel and sample of the first bad sample; empty: none
  int threads = 0;            ///< threads of a local render; 0: a farm's job
};

/// Converts the coordinator's status. Fields that the message lacks become "unknown".
inline Progress progress_of(const farm::JobStatus& status) {
  return {.job = job_view_of(status), .bad_sample_at = status.bad_sample_at()};
}

}  // namespace bandsaw::coordinator
