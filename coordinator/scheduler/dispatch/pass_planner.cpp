// A pass is a range of samples that is rendered for the whole image. For a job with a fixed number
// of samples all passes are planned at once. For a job with an error target they are planned up to
// the next checkpoint, a number of samples at which the error is compared with the target. For a
// job with a time limit a pass is planned when there is nothing else to lease.

#include "coordinator/scheduler/dispatch/pass_planner.h"

#include <algorithm>
#include <vector>

#include "coordinator/scheduler/model/pass_plan.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of incomplete passes of a job with a time limit. The limit is low, because only
/// complete passes are in the job's image. It is above 1, so that no worker waits for the last
/// bands of a pass.
constexpr std::ptrdiff_t kMaxIncompletePasses = 3;

}  // namespace

void PassPlanner::plan_first(Job& job) {
  if (const auto* rule = std::get_if<StopAtSamples>(&job.spec.stop)) {
    if (!job.fixed_samples) {
      fix_samples(job, rule->samples);
    }
    plan_until(job, rule->samples);
  } else if (job.passes.empty()) {
    // A job with a time limit begins with one block (8 samples), the shortest pass. A job with an
    // error target has no checkpoint yet, so its error is unknown (-1).
    plan_until(job, job.timed() ? std::min(kBlockSamples, job.max_samples())
                                : next_checkpoint(/*samples=*/0, /*error=*/-1, /*target=*/0,
                                                  job.max_samples()));
  }
}

void PassPlanner::plan_until(Job& job, std::uint64_t samples) {
  if (job.planned_samples() >= samples) {
    return;
  }
  for (const SampleRange& pass : passes_between(job.planned_samples(), samples)) {
    context_.emit(record::PassPlanned{job.id, pass});
  }
  context_.jobs.mark_leasable(job);
}

bool PassPlanner::plan_timed(Job& job) {
  const auto* rule = std::get_if<StopAtTime>(&job.spec.stop);
  if (rule == nullptr || job.fixed_samples || job.planned_samples() >= rule->max_samples) {
    return false;
  }
  const Time now = context_.clock.wall();
  const double left = rule->seconds - job.elapsed(now);
  const auto incomplete = std::count_if(job.passes.begin(), job.passes.end(),
                                        [](const Pass& pass) { return !pass.coverage.complete(); });
  if (left <= 0 || incomplete >= kMaxIncompletePasses) {
    return false;
  }
  // Number of samples per pixel that are expected to fit into the remaining time.
  const double fits = left * job.throughput.per_second(now) / static_cast<double>(job.pixels());
  context_.emit(
      record::PassPlanned{job.id, next_timed_pass(job.planned_samples(), fits, rule->max_samples)});
  return true;
}

// The record SamplesFixed ends the job after `samples`, so the leases of later samples are ended
// first.
void PassPlanner::fix_samples(Job& job, std::uint64_t samples) {
  std::vector<LeaseId> beyond;
  for (const LeaseId id : job.leases) {
    if (context_.leases.find(id)->band.samples.first >= samples) {
      beyond.push_back(id);
    }
  }
  ledger_.end_all(beyond, LeaseLedger::Revoke::kYes);
  context_.emit(record::SamplesFixed{job.id, samples});
}

}  // namespace bandsaw::coordinator
