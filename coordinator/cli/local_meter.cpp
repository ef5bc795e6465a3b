#include "coordinator/cli/local_meter.h"

#include <algorithm>

namespace bandsaw::coordinator {

LocalMeter::LocalMeter(const JobSpec& spec, RowRange rows, int threads, double now)
    : spec_(spec),
      pixels_(static_cast<double>(spec.settings.width) * rows.count()),
      threads_(threads),
      start_(now) {}

void LocalMeter::reached(std::uint64_t samples) {
  std::uint64_t before = reached_.load(std::memory_order_relaxed);
  while (before < samples &&
         !reached_.compare_exchange_weak(before, samples, std::memory_order_relaxed)) {
  }
}

void LocalMeter::passed(std::uint64_t samples, double error) {
  MutexLock lock(mutex_);
  passed_ = samples;
  if (error != error_) {
    error_ = error;
    error_at_ = samples;
  }
}

void LocalMeter::add(const Counters& counters) {
  MutexLock lock(mutex_);
  counters_.add(counters);
}

double LocalMeter::fraction_of(const JobView& job, std::uint64_t error_at) const {
  const double done = static_cast<double>(job.samples_done) / pixels_;  // samples a pixel
  if (const auto* rule = std::get_if<StopAtSamples>(&spec_.stop)) {
    return done / static_cast<double>(rule->samples);
  }
  if (const auto* rule = std::get_if<StopAtTime>(&spec_.stop)) {
    return job.elapsed_s / rule->seconds;
  }
  const auto& rule = std::get<StopAtError>(spec_.stop);
  if (job.error <= 0) {
    return 0;
  }
  // The error falls about as the square root of the samples that it was measured at.
  const double ratio = job.error / rule.relative_rmse;
  return done / (static_cast<double>(error_at) * std::max(1.0, ratio * ratio));
}

Progress LocalMeter::progress(double now) const {
  Progress progress;
  progress.threads = threads_;
  JobView& job = progress.job;
  job.spec = spec_;
  job.elapsed_s = seconds(now);
  job.samples_done = reached_.load(std::memory_order_relaxed);
  std::uint64_t error_at = 0;
  {
    MutexLock lock(mutex_);
    job.samples_per_pixel = passed_;
    job.error = error_;
    error_at = error_at_;
    job.counters = counters_;
  }
  if (job.counters.bad_samples > 0) {
    progress.bad_sample_at = bad_sample_text(job.counters);
  }
  job.fraction = std::min(fraction_of(job, error_at), 0.999);  // the caller knows when it is done
  if (job.elapsed_s > 0) {
    job.samples_per_s = static_cast<double>(job.samples_done) / job.elapsed_s;
  }
  if (job.fraction > 0.005) {
    job.remaining_s = job.elapsed_s * (1 / job.fraction - 1);
  }
  return progress;
}

}  // namespace bandsaw::coordinator
