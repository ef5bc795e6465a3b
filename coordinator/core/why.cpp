// Why a job is not done yet, as a person would ask it.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// More lines of one kind than this help nobody.
constexpr std::size_t kMostLines = 10;

std::string priority_text(std::int32_t priority) {
  return priority == 0 ? "" : absl::StrCat(" (priority ", priority, ")");
}

std::vector<std::string> failed_because(const Job& job, std::string reason) {
  std::vector<std::string> lines = {std::move(reason)};
  for (const std::string& line : job.log) {
    lines.push_back(absl::StrCat(job.log_of, " | ", line));
  }
  return lines;
}

}  // namespace

std::string Core::State::waiting_reason(const Job& job) const {
  if (job.state != JobState::kRunning || !job.leases.empty()) {
    return job.notice;
  }
  if (!job.any_free() && audits_hold(job)) {
    return audit_reason(job);
  }
  if (waits_for_former()) {
    return absl::StrCat("waits for ", former_.size(),
                        " workers that were there before the coordinator's restart, or before "
                        "all were lost at once");
  }
  if (hunger_.eligible() == 0) {
    return refusals_.empty()
               ? "no worker is connected"
               : absl::StrCat("no worker is connected; ", refusals_.back().worker.name,
                              " was refused: ", refusals_.back().worker.reason);
  }
  if (!someone_may_render(job)) {
    return absl::StrCat("no connected worker can render it; the last: ", job.notice);
  }
  const std::string busy = job.any_free() ? busy_with(job) : "";
  return busy.empty() ? job.notice : busy;
}

/// "all workers are busy with job 5 (priority 10)", or nothing when some are not.
std::string Core::State::busy_with(const Job& job) const {
  std::set<Rank> jobs;
  for (const auto& [id, worker] : workers_.all()) {
    if (!worker.eligible()) {
      continue;
    }
    if (worker.leases.empty()) {
      return "";
    }
    for (const LeaseId lease : worker.leases) {
      jobs.insert(rank(jobs_.at(leases_.find(lease)->job)));
    }
  }
  jobs.erase(rank(job));
  if (jobs.empty()) {
    return "";
  }
  const std::string others = absl::StrJoin(jobs, ", ", [](std::string* out, const Rank& other) {
    absl::StrAppend(out, "job ", other.second, priority_text(-other.first));
  });
  return absl::StrCat("all workers are busy with ", others);
}

std::vector<std::string> Core::State::why(JobId id, Time now) const {
  const Job* job = find(id);
  if (job == nullptr) {
    return {};
  }
  std::vector<std::string> lines = why_of_state(*job, now);
  if (!job->damage.empty()) {
    lines.push_back(job->damage);
  }
  return lines;
}

std::vector<std::string> Core::State::why_of_state(const Job& job, Time now) const {
  const auto with_reason = [&](const char* what) {
    return absl::StrCat(what, job.reason.empty() ? "" : ": ", job.reason);
  };
  switch (job.state) {
    case JobState::kDone:
      return {"it is done"};
    case JobState::kFailed:
      return failed_because(job, with_reason("it failed"));
    case JobState::kCancelled:
      return {"it was cancelled"};
    case JobState::kFinishing:
      return {"every pixel is there; the result is being written"};
    case JobState::kPaused:
      return {with_reason("it is paused")};
    case JobState::kRunning:
      break;
  }
  std::vector<std::string> lines = working_on(job);
  if (const std::string reason = waiting_reason(job); !reason.empty()) {
    lines.push_back(reason);
  }
  if (!job.any_free() && audits_hold(job)) {
    lines.push_back(audit_reason(job));
  } else if (job.leases.empty() && !job.any_free()) {
    lines.push_back("all that is planned is rendered; how much more is needed is being measured");
  }
  if (lines.empty()) {
    lines.push_back("it is about to be given to workers");
  }
  if (const double left = remaining(job, now); left >= 0 && !job.leases.empty()) {
    lines.push_back(
        absl::StrCat("it needs about ", static_cast<std::uint64_t>(left + 0.5), " s more"));
  }
  const std::vector<std::string> not_working = not_working_on(job);
  lines.insert(lines.end(), not_working.begin(), not_working.end());
  return lines;
}

std::vector<std::string> Core::State::working_on(const Job& job) const {
  std::vector<std::string> out;
  const std::vector<JobWorkerView> workers = lines(job);
  for (const JobWorkerView& worker : workers) {
    if (out.size() == kMostLines) {
      out.push_back(absl::StrCat("and ", workers.size() - kMostLines, " more workers"));
      break;
    }
    out.push_back(absl::StrCat(worker.name, " is at it: ", worker.state, ", rows ",
                               worker.rows.first, "–", worker.rows.last));
  }
  return out;
}

std::vector<std::string> Core::State::not_working_on(const Job& job) const {
  std::vector<std::string> out;
  for (const auto& [id, worker] : workers_.all()) {
    if (worker.quarantined || (worker.session && worker.draining)) {
      out.push_back(absl::StrCat(
          worker.name, worker.quarantined ? " gets no work: " : " is leaving: ", worker.reason));
    } else if (worker.eligible() && !may_render(worker, job)) {
      out.push_back(absl::StrCat(worker.name, " is not given it any more: it failed too often"));
    } else if (worker.eligible() && !worker.leases.empty() &&
               leases_.find(worker.leases.front())->job != job.id) {
      const Job& other = jobs_.at(leases_.find(worker.leases.front())->job);
      out.push_back(
          absl::StrCat(worker.name, " is busy with job ", other.id, priority_text(other.priority)));
    }
  }
  for (const Refusal& refusal : refusals_) {
    out.push_back(absl::StrCat(refusal.worker.name, " was refused: ", refusal.worker.reason));
  }
  if (out.size() > kMostLines) {
    const std::size_t more = out.size() - kMostLines;
    out.resize(kMostLines);
    out.push_back(absl::StrCat("and ", more, " more workers that do not render it"));
  }
  return out;
}

}  // namespace bandsaw::coordinator
