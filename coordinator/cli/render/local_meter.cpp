// Collects what the rendering threads report, and computes from it the progress of a render on this
// machine, as the scheduler does for a job of a farm.

#include "coordinator/cli/render/local_meter.h"

#include <algorithm>

#include "coordinator/scheduler/model/pass_plan.h"

namespace bandsaw::coordinator {

LocalMeter::LocalMeter(const JobSpec& spec, RowRange rows, int threads, Clocks start)
    : spec_(spec),
      pixels_(static_cast<double>(spec.settings.width) * rows.count()),
      threads_(threads),
      start_(start) {}

void LocalMeter::reached(std::uint64_t samples) {
  std::uint64_t before = reached_.load(std::memory_order_relaxed);
  while (before < samples &&
         !reached_.compare_exchange_weak(before, samples, std::memory_order_relaxed)) {
  }
}

void LocalMeter::passed(std::uint64_t samples, const std::optional<ErrorEstimate>& error,
                        Clocks now) {
  MutexLock lock(mutex_);
  passed_ = samples;
  if (known_error(error, samples) >= 0) {
    add_point(curve_, {samples, seconds(now.steady_s), now.cpu_s - start_.cpu_s, *error});
  }
}

void LocalMeter::measured(std::uint64_t samples, double error) {
  MutexLock lock(mutex_);
  add_point(measured_, {.samples = samples, .estimate = {.relative_rmse = error}});
}

void LocalMeter::add(const Counters& counters) {
  MutexLock lock(mutex_);
  counters_.add(counters);
}

double LocalMeter::fraction_of(const JobView& job, const ErrorCurve& curve) const {
  const double done = static_cast<double>(job.samples_done) / pixels_;  // samples per pixel
  if (const auto* rule = std::get_if<StopAtSamples>(&spec_.stop)) {
    return done / static_cast<double>(rule->samples);
  }
  if (const auto* rule = std::get_if<StopAtTime>(&spec_.stop)) {
    return job.elapsed_s / rule->seconds;
  }
  const auto& rule = std::get<StopAtError>(spec_.stop);
  // The number of samples per pixel at which the render is expected to end.
  const auto end = expected_end(curve, rule.relative_rmse, planned_, rule.max_samples);
  // In an adaptive render, a pass (a range of samples) omits the pixels that need no more samples.
  // So `done`, the mean over all pixels, is too small. The number of samples at the last point of
  // the curve is used instead.
  const double so_far = rule.adaptive && end ? static_cast<double>(curve.back().samples) : done;
  return end ? so_far / static_cast<double>(*end) : 0;
}

Progress LocalMeter::progress(Clocks now) const {
  Progress progress;
  progress.threads = threads_;
  JobView& job = progress.job;
  job.spec = spec_;
  job.elapsed_s = seconds(now.steady_s);
  job.cpu_s = now.cpu_s - start_.cpu_s;
  job.samples_done = reached_.load(std::memory_order_relaxed);
  ErrorCurve measured;
  {
    MutexLock lock(mutex_);
    measured = measured_;
    job.samples_per_pixel =
        is_adaptive(spec_.stop) ? job.samples_done / static_cast<std::uint64_t>(pixels_) : passed_;
    job.curve = curve_;
    job.counters = counters_;
  }
  job.error = job.curve.empty() ? -1 : job.curve.back().estimate.at_most();
  progress.clean_error = measured.empty() ? -1 : measured.back().estimate.relative_rmse;
  if (job.counters.bad_samples > 0) {
    progress.bad_sample_at = bad_sample_text(job.counters);
  }
  // The fraction stays below 1, because only the caller decides that the render is done.
  job.fraction = std::min(fraction_of(job, measured.empty() ? job.curve : measured), 0.999);
  if (job.elapsed_s > 0) {
    job.samples_per_s = static_cast<double>(job.samples_done) / job.elapsed_s;
  }
  if (job.fraction > 0.005) {  // before that, the prediction would vary too much
    job.remaining_s = job.elapsed_s * (1 / job.fraction - 1);
  }
  return progress;
}

}  // namespace bandsaw::coordinator
