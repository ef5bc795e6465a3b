// A job stands still, by a person's wish or for want of room, and goes on; and who comes first.

#include "absl/strings/str_cat.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// How long the bands in hand of a paused job may still be rendered.
constexpr double kPauseGrace_s = 1;

}  // namespace

/// A job that can be told something; else the step's status says why not.
Job* Core::State::asked_of(JobId id) {
  Job* job = find(id);
  if (job == nullptr) {
    step_.status = absl::NotFoundError(absl::StrCat("there is no job ", id));
    return nullptr;
  }
  if (is_final(job->state)) {
    step_.status = absl::FailedPreconditionError(absl::StrCat("job ", id, " is over"));
    return nullptr;
  }
  return job;
}

void Core::State::on(const input::Pause& in) {
  Job* job = asked_of(in.job);
  if (job == nullptr || job->held) {
    return;
  }
  if (job->state == JobState::kFinishing) {
    step_.status = absl::FailedPreconditionError(
        absl::StrCat("job ", in.job, " is finishing: all of it is rendered"));
    return;
  }
  emit(record::HoldChanged{job->id, true});
  emit(record::StateChanged{job->id, JobState::kPaused, kPausedByAPerson});
  std::vector<LeaseId> waiting;
  for (const LeaseId id : job->leases) {
    if (workers_.by_id(leases_.find(id)->worker)->leases.front() != id) {
      waiting.push_back(id);
    }
  }
  end_all(waiting, Revoke::kYes);
}

void Core::State::on(const input::Resume& in) {
  Job* job = asked_of(in.job);
  if (job == nullptr) {
    return;
  }
  if (job->held) {
    emit(record::HoldChanged{job->id, false});
  }
  if (job->state == JobState::kPaused) {
    resume(*job);
  }
}

/// A person who pauses a job wants the machines now; bands that are rendered and on their way are
/// kept.
void Core::State::take_back_from_paused() {
  std::vector<LeaseId> late;
  for (const auto& [id, lease] : leases_.all()) {
    const Job& job = jobs_.at(lease.job);
    if (job.held && clock_.patience() - job.held_at >= kPauseGrace_s &&
        lease.rows_done < lease.band.rows.count()) {
      late.push_back(id);
    }
  }
  end_all(late, Revoke::kYes);
}

void Core::State::on(const input::SetPriority& in) {
  Job* job = asked_of(in.job);
  if (job == nullptr || job->priority == in.priority) {
    return;
  }
  if (in.priority < -kMostPriority || in.priority > kMostPriority) {
    step_.status = absl::InvalidArgumentError(absl::StrCat(
        "a priority lies in [", -kMostPriority, ", ", kMostPriority, "], is ", in.priority));
    return;
  }
  emit(record::PriorityChanged{job->id, in.priority});
}

void Core::State::on(const input::StorageFailed& in) {
  Job* job = find(in.job);
  if (job != nullptr && (job->state == JobState::kRunning || job->state == JobState::kFinishing)) {
    emit(record::StateChanged{job->id, JobState::kPaused,
                              clean_text(in.reason, wire::kReasonBytes)});
  }
}

void Core::State::on(const input::StorageBack&) {
  const std::set<JobId> active = active_;
  for (const JobId id : active) {
    if (Job& job = jobs_.at(id); job.state == JobState::kPaused && !job.held) {
      resume(job);
    }
  }
}

void Core::State::resume(Job& job) {
  emit(record::StateChanged{job.id, JobState::kRunning, ""});
  for (const LeaseId id : job.leases) {
    leases_.find(id)->advanced_at = clock_.patience();
  }
  touch(job);
  settle(job);
}

}  // namespace bandsaw::coordinator
