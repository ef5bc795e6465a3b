#pragma once

// The word for a job's state: in tables, logs, JSON and metrics.

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

constexpr const char* state_name(JobState state) {
  switch (state) {
    case JobState::kRunning:
      return "running";
    case JobState::kPaused:
      return "paused";
    case JobState::kFinishing:
      return "finishing";
    case JobState::kDone:
      return "done";
    case JobState::kFailed:
      return "failed";
    case JobState::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

}  // namespace bandsaw::coordinator
