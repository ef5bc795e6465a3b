#pragma once

// The farm's state for Prometheus: its text format, version 0.0.4.

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

/// Of jobs: those that are not over have a line each. `free_bytes`: of the coordinator's disk.
std::string metrics(const std::vector<JobView>& jobs, const std::vector<WorkerView>& workers,
                    std::uint64_t free_bytes, const std::string& version);

}  // namespace bandsaw::coordinator
