// The render time of a stored band (a range of rows and samples) tells how fast its worker is and
// how costly its rows are. measure() corrects the costs of the rows and the rates of the worker and
// of the job.

#include "coordinator/scheduler/dispatch/work_rate.h"

#include <algorithm>

#include "coordinator/scheduler/dispatch/probes.h"

namespace bandsaw::coordinator {
namespace {

/// Work rate per thread before anything is measured. It is rather too low than too high, because a
/// first band that is too small costs little, and one that is too large delays the first rows.
constexpr double kGuessedRate = 100'000;
/// Minimum weight of a new measurement in the mean of a worker's rate. It is low, because the rate
/// changes less from band to band than the cost of the rows.
constexpr double kMinWeight = 0.15;

/// Corrects the costs of the band's rows and the rates of the worker and of the job, with the time
/// that the band took.
void measure_work_rate(Worker& worker, Job& job, const input::BandStored& in) {
  Worker::OnJob& on_job = worker.on_job[job.id];
  const double work = job.cost_of(in.band);  // as predicted
  // If the worker's rate is not measured yet, `expected` is the job's mean rate per thread times
  // the worker's number of threads.
  if (job.work_rate.measured()) {
    const double expected = work_rate(worker, job);
    job.cost.learn(in.band.rows, in.render_s * expected / work);
    if (!on_job.work_rate.measured()) {
      on_job.work_rate.measure(expected);
    }
  }
  on_job.work_rate.measure(work / in.render_s, std::max(kMinWeight, 1.0 / (2 + on_job.bands++)));
  job.work_rate.measure(on_job.work_rate.mean() / worker.threads);
  if (job.spec.sequence != 0) {
    worker.on_job[job.spec.sequence].work_rate = on_job.work_rate;
  }
}

/// Returns the measured rate of the worker on this job, or else on another frame of its sequence;
/// nullptr: nothing was measured.
const MeanRate* measured_rate(const Worker& worker, const Job& job) {
  for (const JobId id : {job.id, job.spec.sequence}) {
    const auto on_job = worker.on_job.find(id);
    if (on_job != worker.on_job.end() && on_job->second.work_rate.measured()) {
      return &on_job->second.work_rate;
    }
  }
  return nullptr;
}

}  // namespace

double work_rate_per_thread(const Job& job) {
  return job.work_rate.measured() ? job.work_rate.mean() : kGuessedRate;
}

double work_rate(const Worker& worker, const Job& job) {
  const MeanRate* rate = measured_rate(worker, job);
  return rate != nullptr ? rate->mean() : work_rate_per_thread(job) * worker.threads;
}

bool has_work_rate(const Worker& worker, const Job& job) {
  return measured_rate(worker, job) != nullptr;
}

void measure(Worker& worker, Job& job, const input::BandStored& in) {
  if (in.render_s <= 0) {
    return;
  }
  const std::uint64_t samples = job.samples_of(in.band);
  if (samples == 0) {
    return;  // an adaptive job took no samples in these rows: the time says nothing about speed
  }
  const double speed = static_cast<double>(samples) / in.render_s;
  worker.speed.measure(speed);
  worker.on_job[job.id].speed.measure(speed);
  if (!is_probe(job.spec.settings.height, in.band)) {
    measure_work_rate(worker, job, in);
  }
  // Mean number of pixel samples in a row. The time is divided by it, because RowTimes::measure()
  // expects the time of one pixel sample in each row of the band.
  const double row_samples = static_cast<double>(samples) / in.band.rows.count();
  job.row_times.measure(in.band.rows, in.render_s * worker.threads / row_samples);
}

}  // namespace bandsaw::coordinator
