#pragma once

// State of a render in progress, local or on a farm: the model for the text and JSON output.

#include <string>

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
Progress progress_of(const farm::JobStatus& status);

/// Convert settings and stop rule to messages.
farm::Settings to_proto(const RenderSettings& settings);
farm::StopRule to_proto(const StopRule& stop);

/// "pixel (3, 4), sample 17".
std::string bad_sample_text(const Counters& counters);

}  // namespace bandsaw::coordinator
