// Submitting, cancelling, deciding how many samples, finishing.

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/core/pass_plan.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// Jobs that are known, final ones included: what keeps memory bounded.
constexpr std::size_t kJobsKept = 100'000;

bool in_range(const StopRule& stop) {
  struct InRange {
    static bool samples(std::uint64_t n) { return n >= 1 && n <= kMaxSamples; }
    bool operator()(const StopAtSamples& rule) const { return samples(rule.samples); }
    bool operator()(const StopAtError& rule) const {
      return rule.relative_rmse > 0 && samples(rule.max_samples);
    }
    bool operator()(const StopAtTime& rule) const {
      return rule.seconds > 0 && samples(rule.max_samples);
    }
  };
  return std::visit(InRange{}, stop);
}

}  // namespace

void Core::State::on(const input::Submit& in) {
  if (const auto known = by_request_.find(in.spec.request_id); known != by_request_.end()) {
    step_.job = known->second;
    if (find(known->second)->spec != in.spec) {
      step_.status = absl::AlreadyExistsError(
          absl::StrCat("request id ", in.spec.request_id, " is job ", known->second,
                       " with another scene or other settings; submit with a new request id"));
    }
    return;
  }
  if (in.priority < -kMostPriority || in.priority > kMostPriority) {
    step_.status = absl::InvalidArgumentError(absl::StrCat(
        "a priority lies in [", -kMostPriority, ", ", kMostPriority, "], is ", in.priority));
    return;
  }
  if (!in_range(in.spec.stop) || in.spec.settings.width == 0 || in.spec.settings.height == 0) {
    step_.status = absl::InvalidArgumentError(
        absl::StrCat("the stop rule or the image size is out of range: samples are [1, ",
                     kMaxSamples, "], error and time are above 0, width and height at least 1"));
    return;
  }
  if (active_.size() >= wire::kActiveJobs || jobs_.size() >= kJobsKept) {
    step_.status = absl::ResourceExhaustedError(
        absl::StrCat(active_.size(), " jobs are not done yet (at most ", wire::kActiveJobs, "), ",
                     jobs_.size(), " are known (at most ", kJobsKept,
                     "); wait for a job, cancel one, or keep old ones for a shorter time (bandsaw "
                     "serve --keep-days)"));
    return;
  }
  step_.job = next_job_;
  emit(record::JobAdded{step_.job, in.spec, options_.fitness.pixel_version});
  if (in.priority != 0) {
    emit(record::PriorityChanged{step_.job, in.priority});
  }
  plan_first(*find(step_.job));
}

void Core::State::on(const input::Cancel& in) {
  Job* job = find(in.job);
  if (job == nullptr) {
    step_.status = absl::NotFoundError(absl::StrCat("there is no job ", in.job));
    return;
  }
  if (!is_final(job->state)) {
    end(*job, JobState::kCancelled, "");
  }
}

void Core::State::plan_first(Job& job) {
  if (const auto* rule = std::get_if<StopAtSamples>(&job.spec.stop)) {
    if (!job.fixed) {
      fix(job, rule->samples);
    }
    plan_until(job, rule->samples);
  } else if (job.passes.empty()) {
    plan_until(job, job.timed() ? std::min(kBlockSamples, job.max_samples())
                                : next_look(0, -1, 0, job.max_samples()));
  }
}

void Core::State::plan_until(Job& job, std::uint64_t samples) {
  if (job.planned_samples() >= samples) {
    return;
  }
  for (const SampleRange& pass : passes_between(job.planned_samples(), samples)) {
    emit(record::PassPlanned{job.id, pass});
  }
  touch(job);
}

bool Core::State::plan_timed(Job& job) {
  const auto* rule = std::get_if<StopAtTime>(&job.spec.stop);
  if (rule == nullptr || job.fixed || job.planned_samples() >= rule->max_samples) {
    return false;
  }
  const double left = rule->seconds - elapsed(job, clock_.wall());
  const std::size_t begun = static_cast<std::size_t>(
      std::count_if(job.passes.begin(), job.passes.end(),
                    [](const Pass& pass) { return !pass.coverage.complete(); }));
  if (left <= 0 || begun >= 3) {
    return false;
  }
  const double fits =
      left * job.throughput.per_second(clock_.wall()) / static_cast<double>(job.pixels());
  emit(
      record::PassPlanned{job.id, next_timed_pass(job.planned_samples(), fits, rule->max_samples)});
  return true;
}

void Core::State::on(const input::PassMerged& in) {
  Job* job = find(in.job);
  // More samples than are complete: it is of pixels that were taken back since.
  if (job == nullptr || is_final(job->state) || in.samples < job->error_at ||
      in.samples > job->complete_samples()) {
    return;
  }
  if (const double error = in.error_at_most(); error >= 0) {
    job->error = error;
    job->error_at = in.samples;
    note_error(*job, in.samples, *in.error);
  }
  if (audits_hold(*job)) {
    job->look = in;
  } else {
    look_at_error(*job, in);
  }
}

/// What a restart measures again is known already.
void Core::State::note_error(const Job& job, std::uint64_t samples, const ErrorEstimate& error) {
  const ErrorPoint point{samples, elapsed(job, clock_.wall()), job.totals().cpu_s, error};
  const bool known = !job.curve.empty() &&
                     (job.curve.back().samples > samples ||
                      (job.curve.back().samples == samples && job.curve.back().estimate == error));
  if (!known) {
    emit(record::ErrorMeasured{job.id, point});
  }
}

void Core::State::look_at_error(Job& job, const input::PassMerged& look) {
  const auto* rule = std::get_if<StopAtError>(&job.spec.stop);
  const std::uint64_t samples = look.samples;
  // Only where it was planned to be looked at: what is measured on the way depends on who was fast.
  if (rule == nullptr || job.fixed || samples != job.planned_samples() ||
      samples != job.complete_samples()) {
    return;
  }
  const double error = look.error_at_most();
  const bool reached = error >= 0 && error <= rule->relative_rmse;
  if (reached || samples >= rule->max_samples) {
    fix(job, samples);
    settle(job);
    return;
  }
  const TileGrid grid{job.spec.settings.width, job.spec.settings.height};
  if (rule->adaptive && !job.tile_plan && look.tiles.size() == grid.half_tiles() &&
      time_to_plan_tiles(error, rule->relative_rmse)) {
    emit(record::TilesPlanned{job.id, plan_tiles(grid, look.tiles, samples)});
  }
  const double target = next_target(rule->relative_rmse, rule->adaptive && !job.tile_plan);
  plan_until(job, next_look(samples, error, target, rule->max_samples));
}

void Core::State::fix(Job& job, std::uint64_t samples) {
  std::vector<LeaseId> beyond;
  for (const LeaseId id : job.leases) {
    if (leases_.find(id)->band.samples.first >= samples) {
      beyond.push_back(id);
    }
  }
  end_all(beyond, Revoke::kYes);
  emit(record::SamplesFixed{job.id, samples});
}

void Core::State::settle(Job& job) {
  if (job.state != JobState::kRunning) {
    return;
  }
  if (job.look && !audits_hold(job)) {
    const input::PassMerged look = *std::exchange(job.look, std::nullopt);
    look_at_error(job, look);
  }
  if (const auto* rule = std::get_if<StopAtTime>(&job.spec.stop); rule != nullptr && !job.fixed) {
    const std::uint64_t there = job.complete_samples();
    if (there > 0 && (elapsed(job, clock_.wall()) >= rule->seconds || there >= rule->max_samples)) {
      fix(job, there);
    }
  }
  if (job.state == JobState::kRunning && job.complete() && !audits_hold(job)) {
    job.audits.clear();
    job.image_asked = true;
    emit(record::StateChanged{job.id, JobState::kFinishing, ""});
    act(action::WriteResult{job.id, *job.fixed});
  }
}

void Core::State::end(Job& job, JobState state, const std::string& reason) {
  end_all({job.leases.begin(), job.leases.end()}, Revoke::kYes);
  emit(figures(job));
  for (const WorkerShare& share : job.largest_shares()) {
    emit(record::ShareCounted{job.id, share});
  }
  if (state == JobState::kFailed && !job.log.empty()) {
    emit(record::LastWords{job.id, job.log_of, job.log});
  }
  emit(record::StateChanged{job.id, state, clean_text(reason, wire::kReasonBytes)});
  act(action::DropBands{job.id});
}

void Core::State::on(const input::ResultWritten& in) {
  if (Job* job = find(in.job); job != nullptr && job->state == JobState::kFinishing) {
    end(*job, JobState::kDone, "");
  }
}

void Core::State::on(const input::Tick&) {
  give_up_on_former();
  take_back_from_paused();
  forget_refusals();
  check_silence();
  check_progress();
  const std::set<JobId> active = active_;
  for (const JobId id : active) {
    settle(jobs_.at(id));
    note_time(jobs_.at(id));
    check_unable(jobs_.at(id));
  }
}

double Core::State::elapsed(const Job& job, Time now) const {
  if (is_final(job.state)) {
    return job.figures ? job.figures->elapsed_s : 0;
  }
  return job.elapsed_before + (job.first_lease_at ? std::max(0.0, now - *job.first_lease_at) : 0.0);
}

record::Figures Core::State::figures(const Job& job) const {
  const Totals totals = job.totals();
  return {.job = job.id,
          .elapsed_s = elapsed(job, clock_.wall()),
          .cpu_s = totals.cpu_s,
          .workers_used = static_cast<std::uint32_t>(job.shares.size()),
          .samples = totals.samples,
          .samples_per_pixel = job.complete_samples(),
          .error = job.error,
          .counters = totals.counters};
}

/// A crash loses at most a second of it, or a fiftieth; a long job has no more than a few hundred
/// such records.
void Core::State::note_time(const Job& job) {
  const double spent = elapsed(job, clock_.wall());
  if (job.first_lease_at && spent - job.elapsed_noted >= std::max(1.0, job.elapsed_noted / 50)) {
    emit(record::TimeSpent{job.id, spent});
  }
}

}  // namespace bandsaw::coordinator
