#pragma once

// Progress of a render on this machine: updated by its threads, read by a display.

#include <atomic>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class LocalMeter {
 public:
  /// Seconds of a steady clock, and CPU time of all threads of the process.
  struct Clocks {
    double steady_s = 0;
    double cpu_s = 0;
  };

  /// `rows`: the rows that are rendered. `start`: clocks at the start of the render.
  LocalMeter(const JobSpec& spec, RowRange rows, int threads, Clocks start);

  /// Reports the number of pixel samples done, including the unfinished pass. Thread-safe; values
  /// lower than before are ignored.
  void reached(std::uint64_t samples);
  /// Reports the end of the last planned pass, in samples per pixel.
  void plans(std::uint64_t samples) { planned_ = samples; }
  /// Reports that samples [0, samples) of all rows are done. `error`: std::nullopt if unknown.
  void passed(std::uint64_t samples, const std::optional<ErrorEstimate>& error, Clocks now)
      EXCLUDES(mutex_);
  /// Reports the error that the stop rule compares with its target, if it is not that of passed().
  void measured(std::uint64_t samples, double error) EXCLUDES(mutex_);
  void add(const Counters& counters) EXCLUDES(mutex_);

  double seconds(double steady_s) const { return steady_s - start_.steady_s; }
  Progress progress(Clocks now) const EXCLUDES(mutex_);

 private:
  /// `curve`: the errors that the stop rule compares with its target.
  double fraction_of(const JobView& job, const ErrorCurve& curve) const;

  const JobSpec spec_;
  const double pixels_;
  const int threads_;
  const Clocks start_;
  std::atomic<std::uint64_t> reached_{0};
  std::atomic<std::uint64_t> planned_{0};
  mutable Mutex mutex_;
  std::uint64_t passed_ GUARDED_BY(mutex_) = 0;
  ErrorCurve curve_ GUARDED_BY(mutex_);
  ErrorCurve measured_ GUARDED_BY(mutex_);
  Counters counters_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
