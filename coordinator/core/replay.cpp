// Durable facts: new ones, and those of earlier lives.

#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/core/pass_plan.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// Why a job that was begun with this pixel version does not go on; 0: its journal did not say.
std::string of_two_versions(std::uint32_t begun_with, const Fitness& here) {
  const std::string version =
      begun_with == 0 ? "an earlier pixel version" : absl::StrCat("pixel version ", begun_with);
  return absl::StrCat("begun with ", version, ", this coordinator has ", here.pixel_version,
                      ": an image is of one version; submit it again");
}

}  // namespace

void Core::State::apply(const Record& record) {
  std::visit([this](const auto& r) { apply(r); }, record);
}

void Core::State::apply(const record::JobAdded& r) {
  jobs_.emplace(r.job, Job(r.job, r.spec, r.pixel_version));
  by_request_[r.spec.request_id] = r.job;
  active_.insert(r.job);
  next_job_ = std::max(next_job_, r.job + 1);
}

void Core::State::apply(const record::PassPlanned& r) {
  Job* job = find(r.job);
  if (job != nullptr && !is_final(job->state)) {
    job->add_pass(r.samples);
    touch(*job);
  }
}

void Core::State::apply(const record::TilesPlanned& r) {
  Job* job = find(r.job);
  if (job != nullptr && !is_final(job->state)) {
    job->plan_tiles(r.plan);
  }
}

void Core::State::apply(const record::SamplesFixed& r) {
  if (Job* job = find(r.job)) {
    job->fix(r.samples);
  }
}

void Core::State::apply(const record::StateChanged& r) {
  Job* job = find(r.job);
  if (job == nullptr || is_final(job->state)) {
    return;
  }
  if (is_final(r.state)) {
    job->finish();
    active_.erase(r.job);
    for (auto& [id, worker] : workers_.all()) {
      worker.on_job.erase(r.job);
    }
  }
  job->state = r.state;
  job->reason = r.reason;
  if (r.state != JobState::kRunning) {
    leasable_.erase(rank(*job));
  }
}

void Core::State::apply(const record::PriorityChanged& r) {
  Job* job = find(r.job);
  if (job == nullptr) {
    return;
  }
  const bool leasable = leasable_.erase(rank(*job)) > 0;
  job->priority = r.priority;
  if (leasable) {
    leasable_.insert(rank(*job));
  }
}

void Core::State::apply(const record::HoldChanged& r) {
  if (Job* job = find(r.job)) {
    job->held = r.held;
    job->held_at = clock_.patience();
  }
}

void Core::State::apply(const record::TimeSpent& r) {
  if (Job* job = find(r.job)) {
    job->elapsed_noted = r.elapsed_s;
  }
}

void Core::State::apply(const record::Figures& r) {
  if (Job* job = find(r.job); job != nullptr && !is_final(job->state)) {
    job->figures = r;
  }
}

void Core::State::apply(const record::ErrorMeasured& r) {
  if (Job* job = find(r.job)) {
    add_point(job->curve, r.point);
  }
}

void Core::State::apply(const record::ShareCounted& r) {
  if (Job* job = find(r.job); job != nullptr && job->final_shares.size() < Job::kSharesKept) {
    job->final_shares.push_back(r.share);
  }
}

void Core::State::apply(const record::LastWords& r) {
  if (Job* job = find(r.job)) {
    job->log_of = r.worker;
    job->log = r.log;
  }
}

void Core::State::apply(const record::JobForgotten& r) {
  if (const Job* job = find(r.job)) {
    by_request_.erase(job->spec.request_id);
    active_.erase(r.job);
    jobs_.erase(r.job);
  }
  next_job_ = std::max(next_job_, r.job + 1);
}

void Core::State::apply(const record::WorkerJoined& r) { joined_.insert(r.instance); }
void Core::State::apply(const record::WorkerLeft& r) { joined_.erase(r.instance); }

void Core::State::apply(const record::BandAudited& r) {
  if (Job* job = find(r.job); job != nullptr && !is_final(job->state)) {
    job->audited.insert({r.band, r.renderer});
  }
}

void Core::State::apply(const record::BandLost& r) {
  if (Job* job = find(r.job); job != nullptr && !is_final(job->state)) {
    job->lose(r.band, r.renderer);
  }
}

/// A number of samples that was fixed by a wrong error is not.
void Core::State::apply(const record::ErrorForgotten& r) {
  if (Job* job = find(r.job); job != nullptr && !is_final(job->state)) {
    job->curve.clear();
    job->error = -1;
    job->error_at = 0;
    job->look.reset();
    if (std::holds_alternative<StopAtError>(job->spec.stop)) {
      job->fixed.reset();
    }
  }
}

void Core::State::restore(const input::BandStored& band) {
  Job* job = find(band.job);
  if (job == nullptr) {
    return;
  }
  job->bands_on_disk = true;
  Pass* pass = is_final(job->state) ? nullptr : job->pass_of(band.band);
  const Witness witness = witness_of(band);
  if (pass == nullptr || band.row_digests.size() != band.band.rows.count() ||
      is_quarantined(witness)) {
    return;
  }
  const bool alone = pass->coverage.wanted(band.band) == std::vector<RowRange>{band.band.rows};
  store(*job, *pass, band, witness);
  if (!alone) {
    met_.push_back(band);
  }
}

/// Not while bands are replayed: the film takes all of them first, then what is retracted.
void Core::State::weigh_replayed() {
  for (const input::BandStored& band : std::exchange(met_, {})) {
    Job& job = jobs_.at(band.job);
    if (const Witness witness = witness_of(band); !is_quarantined(witness)) {
      weigh(job, *job.pass_of(band.band), band, witness);
    }
  }
}

Step Core::State::replayed(Time now) {
  clock_.advance(now);
  former_ = joined_;
  awaited_until_ = clock_.patience() + options_.reattach_grace_s;
  weigh_replayed();
  for (auto& [id, job] : jobs_) {
    if (is_final(job.state)) {
      if (job.bands_on_disk) {
        act(action::DropBands{id});
      }
      continue;
    }
    if (job.pixel_version != options_.fitness.pixel_version) {
      end(job, JobState::kFailed, of_two_versions(job.pixel_version, options_.fitness));
      continue;
    }
    plan_first(job);
    note_lost_audited(job);
    job.throughput = {};
    job.elapsed_before = job.elapsed_noted;
    if (job.held) {
      if (job.state != JobState::kPaused) {
        emit(record::StateChanged{id, JobState::kPaused, kPausedByAPerson});
      }
      continue;
    }
    if (job.state != JobState::kRunning) {
      // Paused: whether the disk refuses still is found out by trying. Finishing: the result was
      // not written yet.
      emit(record::StateChanged{id, JobState::kRunning, ""});
    }
    touch(job);
    settle(job);
  }
  return finish_step();
}

}  // namespace bandsaw::coordinator
