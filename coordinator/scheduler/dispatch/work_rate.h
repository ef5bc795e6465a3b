#pragma once

// Work rates: how much work a worker does per second on a job. Work is counted in pixel samples,
// weighted with the relative costs of their rows (CostMap); rates and costs are learnt together.

#include "coordinator/scheduler/context/workers.h"
#include "coordinator/scheduler/model/job.h"

namespace bandsaw::coordinator {

/// Returns the mean work rate of the job's workers per thread; a guess until a rate is measured.
double work_rate_per_thread(const Job& job);
/// Returns the worker's work rate on the job. If none is measured yet, this is the job's rate per
/// thread times the worker's number of threads.
double work_rate(const Worker& worker, const Job& job);
/// Returns true if the worker's rate on this job, or on an earlier frame of its sequence, was
/// measured.
bool has_work_rate(const Worker& worker, const Job& job);
/// Updates rates, costs and row times with the render time of the stored band `in`, which `worker`
/// rendered. No effect if the render time is unknown, or if no samples were taken in the band.
void measure(Worker& worker, Job& job, const input::BandStored& in);

}  // namespace bandsaw::coordinator
