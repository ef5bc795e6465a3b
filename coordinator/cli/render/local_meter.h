#pragma once

// How far a render on this machine is: advanced by its threads, read by a display.

#include <atomic>

#include "coordinator/cli/progress/progress.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class LocalMeter {
 public:
  /// Seconds of a steady clock, and those that all threads of the process have computed.
  struct Clocks {
    double steady_s = 0;
    double cpu_s = 0;
  };

  /// `rows`: those that are rendered. `start`: when they were begun.
  LocalMeter(const JobSpec& spec, RowRange rows, int threads, Clocks start);

  /// Pixel samples done in all, the unfinished pass among them. From any thread; lower values than
  /// before are ignored.
  void reached(std::uint64_t samples);
  /// Passes are planned up to here, in samples a pixel.
  void plans(std::uint64_t samples) { planned_ = samples; }
  /// Samples [0, samples) of all rows are there; error: nothing when it is not known.
  void passed(std::uint64_t samples, const std::optional<ErrorEstimate>& error, Clocks now)
      EXCLUDES(mutex_);
  void add(const Counters& counters) EXCLUDES(mutex_);

  double seconds(double steady_s) const { return steady_s - start_.steady_s; }
  Progress progress(Clocks now) const EXCLUDES(mutex_);

 private:
  double fraction_of(const JobView& job) const;

  const JobSpec spec_;
  const double pixels_;
  const int threads_;
  const Clocks start_;
  std::atomic<std::uint64_t> reached_{0};
  std::atomic<std::uint64_t> planned_{0};
  mutable Mutex mutex_;
  std::uint64_t passed_ GUARDED_BY(mutex_) = 0;
  ErrorCurve curve_ GUARDED_BY(mutex_);
  Counters counters_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
