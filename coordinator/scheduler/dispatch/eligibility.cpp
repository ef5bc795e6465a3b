// A worker may render a job if the job's package fits into the worker's memory and the worker has
// not failed too often at the job. A band (a range of rows and samples) that a worker failed is
// left to other workers as long as one of them can render it. So is a band that the worker's
// machine was rendering when the machine was lost.

#include "coordinator/scheduler/dispatch/eligibility.h"

#include <algorithm>

#include "coordinator/scheduler/model/band_text.h"

namespace bandsaw::coordinator {
namespace {

/// Returns true if the worker failed a band of the job that overlaps `band`.
bool has_failed(const Worker& worker, const Job& job, const Band& band) {
  return std::any_of(job.failures.begin(), job.failures.end(), [&](const FailedAttempt& failure) {
    return failure.instance == worker.instance && overlap(failure.band, band);
  });
}

/// Returns true if a worker on this worker's machine was lost while it held nothing but a suspect
/// band that overlaps `band` (Suspicion::conclusive).
bool machine_was_lost_at(const Worker& worker, const Job& job, const Band& band) {
  return std::any_of(job.suspicions.begin(), job.suspicions.end(), [&](const Suspicion& one) {
    return one.conclusive && one.machine == worker.machine() && overlap(one.band, band);
  });
}

/// Returns true if `condition` holds for some worker.
template <class Condition>
bool any_worker(const Context& context, const Condition& condition) {
  const auto& all = context.workers.all();
  return std::any_of(all.begin(), all.end(),
                     [&](const auto& entry) { return condition(entry.second); });
}

}  // namespace

bool Eligibility::failed_too_often(const Worker& worker, const Job& job) {
  const auto on_job = worker.on_job.find(job.id);
  return on_job != worker.on_job.end() && on_job->second.failures >= kMaxFailuresPerWorker;
}

// A package of unknown size is given only to workers without a limit.
bool Eligibility::fits(const Worker& worker, const Job& job) {
  return worker.memory_bytes == 0 ||
         (job.spec.package_bytes > 0 &&
          job.spec.package_bytes <= worker.memory_bytes / kMemoryPerPackageByte);
}

bool Eligibility::may_audit(const Worker& worker, const Job& job) const {
  return fits(worker, job) && !failed_too_often(worker, job);
}

bool Eligibility::may_render(const Worker& worker, const Job& job) const {
  const bool wanted =
      worker.browser ? !audits_lag(job) : context_.options.browsers != Browsers::kOnly;
  return wanted && may_audit(worker, job);
}

bool Eligibility::audits_lag(const Job& job) const {
  return context_.available.natives() > 0 && job.audits.size() >= Job::kMaxAudits / 2;
}

bool Eligibility::native_gave_up(const Job& job) const {
  return any_worker(context_, [&](const Worker& worker) {
    return !worker.browser && worker.eligible() && failed_too_often(worker, job);
  });
}

bool Eligibility::someone_may_render(const Job& job) const {
  return any_worker(
      context_, [&](const Worker& worker) { return worker.eligible() && may_render(worker, job); });
}

bool Eligibility::someone_else(const Job& job, const Band& band) const {
  return any_worker(context_, [&](const Worker& worker) {
    return worker.eligible() && may_render(worker, job) && !has_failed(worker, job, band);
  });
}

bool Eligibility::another_machine(const Job& job, const Band& band) const {
  return any_worker(context_, [&](const Worker& worker) {
    return worker.eligible() && may_render(worker, job) &&
           !machine_was_lost_at(worker, job, band) && !has_failed(worker, job, band);
  });
}

std::vector<Band> Eligibility::left_to_others(const Job& job, const Worker& worker) const {
  std::vector<Band> bands;
  for (const FailedAttempt& failure : job.failures) {
    if (failure.instance == worker.instance && someone_else(job, failure.band)) {
      bands.push_back(failure.band);
    }
  }
  for (const Suspicion& one : job.suspicions) {
    if (one.conclusive && one.machine == worker.machine() && another_machine(job, one.band)) {
      bands.push_back(one.band);
    }
  }
  return bands;
}

bool Eligibility::left_to_others(const Job& job, const Worker& worker, const Band& band) const {
  const std::vector<Band> bands = left_to_others(job, worker);
  return std::any_of(bands.begin(), bands.end(), [&](const Band& b) { return overlap(b, band); });
}

}  // namespace bandsaw::coordinator
