#pragma once

// Crash attribution: distinguishes a band that crashes its workers from workers lost by chance.
//
// A lost worker proves nothing about its band: nobody sees whether its process, its machine or its
// network failed. So the bands that it held become suspect and are retried in pieces, each by a
// worker that holds nothing else. If that worker is lost as well, its crash counts against the
// piece. A job fails when more machines were lost at a piece than chance explains (CrashRate).

#include <cstddef>
#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"

namespace bandsaw::coordinator {

/// A band (range of rows and samples) that a worker may have been rendering when it was lost.
struct HeldBand {
  JobId job = 0;
  Band band;
  bool alone = false;  ///< the worker held nothing else
};

/// Estimates how often a worker is lost at a band for reasons other than the band. This rate
/// determines how many crashes at one band are needed to blame the band.
class CrashRate {
 public:
  void add_band() { add(bands_); }
  void add_crash() { add(crashes_); }

  /// Returns how many workers must be lost at one band before the band is blamed. Each of them must
  /// have held nothing else. The number is the smallest for which the probability that all of them
  /// were lost for other reasons is at most kMistake. It is at least `min_crashes`, and at most
  /// kMaxRequired unless `min_crashes` is larger. `own`: number of losses at this band that
  /// add_crash() counted. The rate is computed without these losses.
  std::size_t required(std::size_t min_crashes, std::size_t own) const;

 private:
  static constexpr double kMistake = 1e-6;
  /// Without this bound, a farm that loses very many workers would never blame a band.
  static constexpr std::size_t kMaxRequired = 30;
  /// Prior for a farm of which nothing is known: as if one crash at twenty bands had been seen.
  static constexpr double kPriorBands = 20;
  static constexpr double kPriorCrashes = 1;
  /// Both counts are halved when their sum exceeds this, so that old events lose weight.
  static constexpr double kMaxCount = 2'000;

  /// Adds 1 to `count`, which is bands_ or crashes_.
  void add(double& count);

  double bands_ = 0;    ///< number of bands that were stored
  double crashes_ = 0;  ///< number of workers that were lost at a band
};

class CrashAttribution {
 public:
  CrashAttribution(Context& context, const Eligibility& eligibility, JobLifecycle& lifecycle)
      : context_(context), eligibility_(eligibility), lifecycle_(lifecycle) {}

  /// Returns the bands that may have crashed the worker if it is lost now. MUST be called before
  /// its leases are ended.
  std::vector<HeldBand> held_bands(const Worker& worker) const;
  /// Makes these bands suspect; fails their job if there are too many crashes at one of them.
  void worker_lost(const Worker& worker, const std::vector<HeldBand>& held);
  /// A worker that reconnects has not crashed: ends the suspicions that it caused.
  void worker_connected(const Worker& worker);
  /// Counts a stored band that was not suspect.
  void count_band() { rate_.add_band(); }

 private:
  void add_suspicion(Job& job, const Worker& worker, const HeldBand& held);
  void fail_if_blamed(Job& job, const Worker& worker, const Band& band);

  Context& context_;
  const Eligibility& eligibility_;
  JobLifecycle& lifecycle_;
  CrashRate rate_;  ///< measured in this run of the coordinator
};

}  // namespace bandsaw::coordinator
