#pragma once

// How far a render on this machine is: advanced by its threads, read by a display.

#include <atomic>

#include "coordinator/cli/progress.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

class LocalMeter {
 public:
  /// `rows`: those that are rendered. `now`: the start, seconds of a steady clock.
  LocalMeter(const JobSpec& spec, RowRange rows, int threads, double now);

  /// Pixel samples done in all, the unfinished pass among them. From any thread; lower values than
  /// before are ignored.
  void reached(std::uint64_t samples);
  /// Samples [0, samples) of all rows are there; `error` is negative when it is not known.
  void passed(std::uint64_t samples, double error) EXCLUDES(mutex_);
  void add(const Counters& counters) EXCLUDES(mutex_);

  double seconds(double now) const { return now - start_; }
  Progress progress(double now) const EXCLUDES(mutex_);

 private:
  /// `error_at`: the samples a pixel that the error was measured at.
  double fraction_of(const JobView& job, std::uint64_t error_at) const;

  const JobSpec spec_;
  const double pixels_;
  const int threads_;
  const double start_;
  std::atomic<std::uint64_t> reached_{0};
  mutable Mutex mutex_;
  std::uint64_t passed_ GUARDED_BY(mutex_) = 0;
  double error_ GUARDED_BY(mutex_) = -1;
  std::uint64_t error_at_ GUARDED_BY(mutex_) = 0;
  Counters counters_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
