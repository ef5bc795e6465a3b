// Old jobs are forgotten, and what is durable is written down anew.

#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

void Core::State::on(const input::Forget& in) {
  for (const JobId id : in.jobs) {
    if (const Job* job = find(id); job != nullptr && is_final(job->state)) {
      emit(record::JobForgotten{id});
      act(action::DropJob{id});
    }
  }
}

void Core::State::add_records(const Job& job, std::vector<Record>& out) {
  out.push_back(record::JobAdded{job.id, job.spec, job.pixel_version});
  if (job.priority != 0) {
    out.push_back(record::PriorityChanged{job.id, job.priority});
  }
  if (job.held) {
    out.push_back(record::HoldChanged{job.id, true});
  }
  bool tiles = !job.tile_plan;  // said, or nothing to say
  for (const Pass& pass : job.passes) {
    if (!tiles && pass.samples.first >= job.tile_plan->pilot) {
      out.push_back(record::TilesPlanned{job.id, *job.tile_plan});
      tiles = true;
    }
    out.push_back(record::PassPlanned{job.id, pass.samples});
  }
  if (!tiles) {
    out.push_back(record::TilesPlanned{job.id, *job.tile_plan});
  }
  if (job.fixed) {
    out.push_back(record::SamplesFixed{job.id, *job.fixed});
  }
  if (job.elapsed_noted > 0) {
    out.push_back(record::TimeSpent{job.id, job.elapsed_noted});
  }
  for (const ErrorPoint& point : job.curve) {
    out.push_back(record::ErrorMeasured{job.id, point});
  }
  for (const auto& [band, renderer] : job.audited) {
    out.push_back(record::BandAudited{job.id, band, renderer});
  }
  if (job.figures) {
    out.push_back(*job.figures);
  }
  for (const WorkerShare& share : job.final_shares) {
    out.push_back(record::ShareCounted{job.id, share});
  }
  if (is_final(job.state) && !job.log.empty()) {
    out.push_back(record::LastWords{job.id, job.log_of, job.log});
  }
  if (job.state != JobState::kRunning || !job.reason.empty()) {
    out.push_back(record::StateChanged{job.id, job.state, job.reason});
  }
}

std::vector<Record> Core::State::snapshot() const {
  std::vector<Record> records;
  for (const auto& [id, job] : jobs_) {
    add_records(job, records);
  }
  // The last number given stays given.
  if (next_job_ > 1 && !jobs_.contains(next_job_ - 1)) {
    records.push_back(record::JobForgotten{next_job_ - 1});
  }
  add_quarantine(records);
  for (const std::string& instance : joined_) {
    records.push_back(record::WorkerJoined{instance});
  }
  return records;
}

}  // namespace bandsaw::coordinator
