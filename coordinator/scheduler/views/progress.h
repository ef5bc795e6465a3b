#pragma once

// Progress of a job: the fraction that is done, the remaining time, and the workers that render it.

#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the part of the job's work that is done, [0, 1]. For a job with a time limit, the result
/// is the part of its time that has passed. For a job with an error target, it is 0 until the first
/// error is measured.
double fraction_done(const Job& job, Time now);

/// Returns the remaining time in seconds; negative: unknown. For a job with a time limit, it is the
/// rest of that time. For other jobs, it is the thread time of all samples to come, divided by the
/// number of threads that work on the job. The thread time comes from measured render times of rows
/// (RowTimes), not from their relative costs (CostMap).
double remaining_s(const Context& context, const Job& job, Time now);

/// Returns the workers that have leases of the job, sorted by name.
std::vector<JobWorkerView> workers_on(const Context& context, const Job& job);

}  // namespace bandsaw::coordinator
