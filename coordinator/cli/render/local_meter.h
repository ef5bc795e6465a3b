#pragma once

// Measures the progress of a render on this machine (`bandsaw render`). The rendering threads
// report to it, and a display reads it.

#include <atomic>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Thread-safe.
class LocalMeter {
 public:
  struct Clocks {
    double steady_s = 0;  ///< seconds of a steady clock
    double cpu_s = 0;     ///< CPU time of all threads of the process, in seconds
  };

  /// `rows`: the rows that are rendered. `start`: the clocks at the start of the render.
  LocalMeter(const JobSpec& spec, RowRange rows, int threads, Clocks start);

  /// Reports how many samples are done in all pixels together, including those of a pass (a range
  /// of samples of the image) that is not finished. A number that is lower than an earlier one is
  /// ignored.
  void reached(std::uint64_t samples);
  /// Reports the end of the last planned pass, in samples per pixel.
  void plans(std::uint64_t samples) { planned_ = samples; }
  /// Reports that samples [0, samples) of each pixel are done. `error`: std::nullopt if unknown.
  void passed(std::uint64_t samples, const std::optional<ErrorEstimate>& error, Clocks now)
      EXCLUDES(mutex_);
  /// Reports the relative RMSE of the clean image, that is the image without noise that --denoise
  /// makes. `samples`: samples per pixel so far. With --denoise, the stop rule compares this error
  /// with the target. Without --denoise, the stop rule compares the error that passed() was given.
  void measured(std::uint64_t samples, double error) EXCLUDES(mutex_);
  /// Adds the counters (rays, bad samples, …) of rows that are done.
  void add(const Counters& counters) EXCLUDES(mutex_);

  /// Returns how many seconds the render has taken when the steady clock shows `steady_s`.
  double seconds(double steady_s) const { return steady_s - start_.steady_s; }
  /// Returns the state of the render. Progress::job.fraction stays below 1 even if all samples are
  /// done.
  Progress progress(Clocks now) const EXCLUDES(mutex_);

 private:
  /// Returns the fraction of the render that is done. A value of 1 or more means that all of it is
  /// done. `curve`: the errors that the stop rule compares with its target.
  double fraction_of(const JobView& job, const ErrorCurve& curve) const;

  const JobSpec spec_;
  const double pixels_;  ///< number of pixels that are rendered
  const int threads_;
  const Clocks start_;
  std::atomic<std::uint64_t> reached_{0};  ///< samples in all pixels together
  std::atomic<std::uint64_t> planned_{0};  ///< samples per pixel
  mutable Mutex mutex_;
  std::uint64_t passed_ GUARDED_BY(mutex_) = 0;  ///< samples per pixel
  ErrorCurve curve_ GUARDED_BY(mutex_);          ///< errors of passed()
  ErrorCurve measured_ GUARDED_BY(mutex_);       ///< errors of measured(); may be empty
  Counters counters_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
