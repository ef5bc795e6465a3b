#pragma once

// Work rates: how much work (in units of CostMap) a worker does per second on a job. They are
// learnt together with the costs of the rows.

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
/// Updates rates, costs and row times with the render time of a stored band.
void measure(Worker& worker, Job& job, const input::BandStored& in);

}  // namespace bandsaw::coordinator
