#pragma once

// Writes the farm's state as metrics in the text format of Prometheus, version 0.0.4.

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

/// Formats the metrics. A metric of jobs, such as bandsaw_job_error, has a line for each unfinished
/// job, but no line for a job for which the value is unknown. `free_bytes`: free space of the
/// coordinator's disk.
std::string metrics(const std::vector<JobView>& jobs, const std::vector<WorkerView>& workers,
                    std::uint64_t free_bytes, const std::string& version);

}  // namespace bandsaw::coordinator
