// A table of all jobs, which finds a job by its id or its request id. It also has the set of the
// active jobs (those that are not final), and the set of the leasable jobs (those that may have
// something to lease). The leasable jobs are ordered by rank, that is by priority and then by id.

#include "coordinator/scheduler/context/job_table.h"

namespace bandsaw::coordinator {

Job* JobTable::find(JobId id) {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

const Job* JobTable::find(JobId id) const {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

std::optional<JobId> JobTable::by_request(const std::string& request_id) const {
  const auto it = by_request_.find(request_id);
  return it == by_request_.end() ? std::nullopt : std::optional(it->second);
}

void JobTable::add(JobId id, const JobSpec& spec, std::uint32_t pixel_version) {
  all_.emplace(id, Job(id, spec, pixel_version));
  by_request_[spec.request_id] = id;
  active_.insert(id);
  never_reuse(id);
}

void JobTable::remove(JobId id) {
  if (const Job* job = find(id)) {
    by_request_.erase(job->spec.request_id);
    active_.erase(id);
    all_.erase(id);
  }
  never_reuse(id);
}

void JobTable::set_priority(Job& job, std::int32_t priority) {
  const bool leasable = leasable_.erase(rank(job)) > 0;
  job.priority = priority;
  if (leasable) {
    leasable_.insert(rank(job));
  }
}

void JobTable::mark_leasable(const Job& job) {
  if (job.state == JobState::kRunning) {
    leasable_.insert(rank(job));
  }
}

}  // namespace bandsaw::coordinator
