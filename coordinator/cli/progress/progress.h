#pragma once

// What is known of a render while it goes on, wherever it goes on: the model that the texts and the
// JSON lines are made of.

#include <string>

#include "coordinator/core/types.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

/// A farm's job, or a local render (id 0, no workers).
struct Progress {
  JobView job;
  std::string bad_sample_at;  ///< the pixel and sample of the first bad sample; empty: none
  int threads = 0;            ///< of a local render; 0: a farm's job
};

/// The job as the coordinator tells it. What the message leaves out becomes "not known".
Progress progress_of(const farm::JobStatus& status);

/// Settings and stop rule as they travel.
farm::Settings to_proto(const RenderSettings& settings);
farm::StopRule to_proto(const StopRule& stop);

/// "pixel (3, 4), sample 17".
std::string bad_sample_text(const Counters& counters);

}  // namespace bandsaw::coordinator
