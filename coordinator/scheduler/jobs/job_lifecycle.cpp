// advance() is called after each change of a job's rows. It evaluates a checkpoint that had to wait
// for audits, ends a job whose time is up, and requests the image when all passes are complete. A
// checkpoint is a number of samples at which the error is compared with its target. An audit is a
// second rendering of stored rows, to compare. end() is the only way to a final state.

#include "coordinator/scheduler/jobs/job_lifecycle.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "coordinator/scheduler/model/pass_plan.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// Time that workers may still render the leases of a job that a user paused.
constexpr double kPauseGrace_s = 1;

}  // namespace

void JobLifecycle::advance(Job& job) {
  if (job.state != JobState::kRunning) {
    return;
  }
  if (job.pending_checkpoint && !audits_.block(job)) {
    const input::PassMerged merged = *std::exchange(job.pending_checkpoint, std::nullopt);
    evaluate_checkpoint(job, merged);
  }
  const auto* rule = std::get_if<StopAtTime>(&job.spec.stop);
  if (rule != nullptr && !job.fixed_samples) {
    const std::uint64_t complete = job.complete_samples();
    const bool over = job.elapsed(context_.clock.wall()) >= rule->seconds;
    if (complete > 0 && (over || complete >= rule->max_samples)) {
      planner_.fix_samples(job, complete);
    }
  }
  if (job.state == JobState::kRunning && job.complete() && !audits_.block(job)) {
    job.audits.clear();
    job.image_requested = true;
    context_.emit(record::StateChanged{job.id, JobState::kFinishing, ""});
    context_.act(action::WriteResult{job.id, *job.fixed_samples});
  }
}

void JobLifecycle::pass_merged(const input::PassMerged& in) {
  Job* job = context_.jobs.find(in.job);
  // An error that was estimated from fewer samples than the newest known error is out of date. If
  // it was estimated from more samples than are complete now, some of its rows have since been
  // removed, because the machine that rendered them was wrong.
  if (job == nullptr || is_final(job->state) || in.samples < job->error_samples ||
      in.samples > job->complete_samples()) {
    return;
  }
  if (const double error = in.error_at_most(); error >= 0) {
    job->error = error;
    job->error_samples = in.samples;
    note_error(*job, in.samples, *in.error);
  }
  if (audits_.block(*job)) {
    job->pending_checkpoint = in;
  } else {
    evaluate_checkpoint(*job, in);
  }
}

/// Journals the error, unless the journal has it already: after a restart, errors are measured
/// again.
void JobLifecycle::note_error(const Job& job, std::uint64_t samples, const ErrorEstimate& error) {
  const ErrorPoint point{samples, job.elapsed(context_.clock.wall()), job.totals().cpu_s, error};
  const bool known = !job.curve.empty() &&
                     (job.curve.back().samples > samples ||
                      (job.curve.back().samples == samples && job.curve.back().estimate == error));
  if (!known) {
    context_.emit(record::ErrorMeasured{job.id, point});
  }
}

/// At a checkpoint, decides whether the job ends here, and plans the passes up to the next
/// checkpoint. In an adaptive job, also plans how many samples each half tile (half of the pixels
/// of a 16 x 16 tile) takes, once the error is small enough for this. The error after a pass that
/// is no checkpoint is ignored, because whether such an error is measured depends on the workers'
/// speed.
void JobLifecycle::evaluate_checkpoint(Job& job, const input::PassMerged& merged) {
  const auto* rule = std::get_if<StopAtError>(&job.spec.stop);
  const std::uint64_t samples = merged.samples;
  if (rule == nullptr || job.fixed_samples || samples != job.planned_samples() ||
      samples != job.complete_samples()) {
    return;
  }
  // If a crash left only some of the records of a plan, the planned passes do not end at a
  // checkpoint. The journal writes all or none of these records, but the scheduler does not rely on
  // that.
  if (const std::uint64_t past = samples % kCheckpointStep;
      past != 0 && samples < rule->max_samples) {
    planner_.plan_until(job, std::min(samples - past + kCheckpointStep, rule->max_samples));
    return;
  }
  const double error = merged.error_at_most();
  const bool reached = error >= 0 && error <= rule->relative_rmse;
  if (reached || samples >= rule->max_samples) {
    planner_.fix_samples(job, samples);
    advance(job);
    return;
  }
  const TileGrid grid{job.spec.settings.width, job.spec.settings.height};
  if (rule->adaptive && !job.tile_plan && merged.tiles.size() == grid.half_tiles() &&
      time_to_plan_tiles(error, rule->relative_rmse)) {
    context_.emit(record::TilesPlanned{job.id, plan_tiles(grid, merged.tiles, samples)});
  }
  const double target = next_target(rule->relative_rmse, rule->adaptive && !job.tile_plan);
  planner_.plan_until(job, next_checkpoint(samples, error, target, rule->max_samples));
}

void JobLifecycle::result_written(const input::ResultWritten& in) {
  Job* job = context_.jobs.find(in.job);
  if (job != nullptr && job->state == JobState::kFinishing) {
    end(*job, JobState::kDone, "");
  }
}

void JobLifecycle::end(Job& job, JobState state, const std::string& reason) {
  ledger_.end_all({job.leases.begin(), job.leases.end()}, LeaseLedger::Revoke::kYes);
  context_.emit(summary(job));
  for (const WorkerShare& share : job.largest_shares()) {
    context_.emit(record::ShareCounted{job.id, share});
  }
  if (state == JobState::kFailed && !job.log.empty()) {
    context_.emit(record::FailureLog{job.id, job.log_of, job.log});
  }
  context_.emit(record::StateChanged{job.id, state, clean_text(reason, wire::kReasonBytes)});
  context_.act(action::DropBands{job.id});
}

record::JobSummary JobLifecycle::summary(const Job& job) const {
  const Totals totals = job.totals();
  return {.job = job.id,
          .elapsed_s = job.elapsed(context_.clock.wall()),
          .cpu_s = totals.cpu_s,
          .workers_used = static_cast<std::uint32_t>(job.shares.size()),
          .samples = totals.samples,
          .samples_per_pixel = job.complete_samples(),
          .error = job.error,
          .counters = totals.counters};
}

void JobLifecycle::storage_failed(const input::StorageFailed& in) {
  const Job* job = context_.jobs.find(in.job);
  if (job != nullptr && (job->state == JobState::kRunning || job->state == JobState::kFinishing)) {
    context_.emit(record::StateChanged{job->id, JobState::kPaused,
                                       clean_text(in.reason, wire::kReasonBytes)});
  }
}

void JobLifecycle::storage_back() {
  const std::set<JobId> active = context_.jobs.active();
  for (const JobId id : active) {
    if (Job& job = context_.jobs.at(id); job.state == JobState::kPaused && !job.held) {
      resume(job);
    }
  }
}

void JobLifecycle::resume(Job& job) {
  context_.emit(record::StateChanged{job.id, JobState::kRunning, ""});
  for (const LeaseId id : job.leases) {  // leases that workers kept while the job was paused
    context_.leases.find(id)->advanced_at = context_.clock.timeout_clock();
    ledger_.start_clocks(job);
  }
  context_.jobs.mark_leasable(job);
  advance(job);
}

void JobLifecycle::revoke_from_held_jobs() {
  std::vector<LeaseId> late;
  for (const auto& [id, lease] : context_.leases.all()) {
    const Job& job = context_.jobs.at(lease.job);
    if (job.held && context_.clock.timeout_clock() - job.held_at >= kPauseGrace_s &&
        lease.rows_done < lease.band.rows.count()) {
      late.push_back(id);
    }
  }
  ledger_.end_all(late, LeaseLedger::Revoke::kYes);
}

void JobLifecycle::note_time(const Job& job) {
  const double spent = job.elapsed(context_.clock.wall());
  if (job.clock.runs() && spent - job.elapsed_noted >= std::max(1.0, job.elapsed_noted / 50)) {
    context_.emit(record::TimeSpent{job.id, spent});
  }
}

}  // namespace bandsaw::coordinator
