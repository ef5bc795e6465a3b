#pragma once

// Plans the passes of jobs (model/pass_plan.h), and decides after how many samples a job ends. A
// pass is a range of samples that is rendered for the whole image.

#include <cstdint>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"

namespace bandsaw::coordinator {

class PassPlanner {
 public:
  PassPlanner(Context& context, LeaseLedger& ledger) : context_(context), ledger_(ledger) {}

  /// Plans the passes that need no measurements, unless they are planned already. For a job with a
  /// fixed number of samples, these are all its passes; for any other job, only the first passes.
  void plan_first(Job& job);
  /// Plans passes up to this number of samples per pixel.
  void plan_until(Job& job, std::uint64_t samples);
  /// Plans the next pass of a job with a time limit and returns true. Returns false and plans
  /// nothing if the job has no time limit, if its time is up, if all its passes are planned, or if
  /// enough passes are in progress.
  bool plan_timed(Job& job);
  /// Makes the job end after this many samples per pixel: revokes the leases of later samples.
  void fix_samples(Job& job, std::uint64_t samples);

 private:
  Context& context_;
  LeaseLedger& ledger_;
};

}  // namespace bandsaw::coordinator
