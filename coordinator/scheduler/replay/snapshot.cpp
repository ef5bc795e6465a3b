// Lists the records that rebuild the present state. The records of each job and sequence come in an
// order in which they can be replayed.

#include "coordinator/scheduler/replay/snapshot.h"

#include <string>

namespace bandsaw::coordinator {
namespace {

/// Appends the passes, and the tile plan before the first pass that it applies to. The tile plan
/// says how many samples each half tile (half of the pixels of a 16 x 16 tile) takes.
void add_passes(const Job& job, std::vector<Record>& out) {
  bool plan_added = !job.tile_plan;
  for (const Pass& pass : job.passes) {
    if (!plan_added && pass.samples.first >= job.tile_plan->pilot) {
      out.push_back(record::TilesPlanned{job.id, *job.tile_plan});
      plan_added = true;
    }
    out.push_back(record::PassPlanned{job.id, pass.samples});
  }
  if (!plan_added) {
    out.push_back(record::TilesPlanned{job.id, *job.tile_plan});
  }
}

/// Appends the records of a job. The record of its state is the last, because many of the other
/// records have no effect on a final job.
void add_job(const Job& job, std::vector<Record>& out) {
  out.push_back(record::JobAdded{job.id, job.spec, job.pixel_version});
  if (job.priority != 0) {
    out.push_back(record::PriorityChanged{job.id, job.priority});
  }
  if (job.held) {
    out.push_back(record::HoldChanged{job.id, /*held=*/true});
  }
  add_passes(job, out);
  if (job.fixed_samples) {
    out.push_back(record::SamplesFixed{job.id, *job.fixed_samples});
  }
  if (job.elapsed_noted > 0) {
    out.push_back(record::TimeSpent{job.id, job.elapsed_noted});
  }
  for (const ErrorPoint& point : job.curve) {
    out.push_back(record::ErrorMeasured{job.id, point});
  }
  for (const auto& [band, process] : job.audited) {
    out.push_back(record::BandAudited{job.id, band, process});
  }
  for (const record::RowDisputed& dispute : job.disputes) {
    out.push_back(dispute);
  }
  if (job.summary) {
    out.push_back(*job.summary);
  }
  for (const WorkerShare& share : job.final_shares) {
    out.push_back(record::ShareCounted{job.id, share});
  }
  if (is_final(job.state) && !job.log.empty()) {
    out.push_back(record::FailureLog{job.id, job.log_of, job.log});
  }
  if (job.state != JobState::kRunning || !job.reason.empty()) {
    out.push_back(record::StateChanged{job.id, job.state, job.reason});
  }
}

/// Appends the records of a sequence. They MUST come before the records of its frame jobs.
void add_sequence(const Sequence& sequence, std::vector<Record>& out) {
  out.push_back(record::SequenceAdded{sequence.id, sequence.spec, sequence.pixel_version});
  if (sequence.priority != 0) {
    out.push_back(record::PriorityChanged{sequence.id, sequence.priority});
  }
  if (sequence.held) {
    out.push_back(record::HoldChanged{sequence.id, /*held=*/true});
  }
  for (const Sequence::Frame& frame : sequence.frames()) {
    if (!frame.manifest.empty()) {
      out.push_back(record::FrameWaits{sequence.id, frame.number, frame.manifest,
                                       frame.package_bytes, frame.failures,
                                       frame.state == FrameState::kWaiting ? frame.reason : ""});
    }
  }
  if (sequence.elapsed_noted > 0) {
    out.push_back(record::TimeSpent{sequence.id, sequence.elapsed_noted});
  }
  if (sequence.state != JobState::kRunning) {
    out.push_back(record::StateChanged{sequence.id, sequence.state, sequence.reason});
  }
}

}  // namespace

std::vector<Record> snapshot(const Context& context) {
  std::vector<Record> records;
  for (const auto& [id, sequence] : context.sequences.all()) {
    add_sequence(sequence, records);
  }
  for (const auto& [id, job] : context.jobs.all()) {
    add_job(job, records);
  }
  // If the job with the last id was forgotten, this record keeps the id from being used again.
  if (const JobId next = context.jobs.next_id(); next > 1 &&
                                                 !context.jobs.all().contains(next - 1) &&
                                                 context.sequences.find(next - 1) == nullptr) {
    records.push_back(record::JobForgotten{next - 1});
  }
  context.quarantine.add_records(records);
  // The record WorkerJoined also says that a worker is a browser. So a browser that has left gets a
  // record WorkerJoined, and after it a record WorkerLeft.
  for (const auto& [process, instance] : context.browsers) {
    if (!context.joined.contains(instance)) {
      records.push_back(record::WorkerJoined{instance, /*browser=*/true});
      records.push_back(record::WorkerLeft{instance});
    }
  }
  for (const std::string& instance : context.joined) {
    records.push_back(record::WorkerJoined{instance, context.is_browser(instance)});
  }
  return records;
}

}  // namespace bandsaw::coordinator
