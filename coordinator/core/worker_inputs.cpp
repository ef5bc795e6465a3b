// Workers come, are heard of, and go.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/core/fitness.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint32_t kRetryUnfitMs = 60'000;
constexpr double kRefusalKept_s = 3.0 * kRetryUnfitMs / 1000;
constexpr std::uint32_t kRetryFullMs = 10'000;

}  // namespace

void Core::State::on(const input::Hello& in) {
  if (const auto why = unfit(options_.fitness, in.worker)) {
    remember_refusal(in.worker, *why);
    act(action::Refuse{in.session, *why, kRetryUnfitMs});
    return;
  }
  learn_name(in.worker);
  if (const auto why = kept_away(in.worker.instance, in.worker.name)) {
    act(action::Refuse{in.session, *why, kRetryUnfitMs});
    return;
  }
  Worker* worker = workers_.by_instance(in.worker.instance);
  const bool there = worker != nullptr && worker->session;
  if (!there && workers_.connected() >= wire::kWorkers) {
    act(action::Refuse{in.session, absl::StrCat("the farm is full: ", wire::kWorkers, " workers"),
                       kRetryFullMs});
    return;
  }
  if (there && *worker->session != in.session) {
    act(action::Close{*worker->session, "the worker has opened another session"});
  }
  if (worker == nullptr) {
    worker = &workers_.add(in.worker.instance, in.worker.name);
  }
  welcome(*worker, in);
}

void Core::State::remember_refusal(const WorkerHello& worker, const std::string& reason) {
  std::erase_if(refusals_, [&](const Refusal& r) { return r.instance == worker.instance; });
  WorkerView view;
  view.name = worker.name;
  view.state = "refused";
  view.reason = clean_text(reason, wire::kReasonBytes);
  view.address = worker.address;
  view.build = worker.build;
  view.threads = worker.threads;
  refusals_.push_back({worker.instance, std::move(view), clock_.wall()});
  if (refusals_.size() > kRefusalsKept) {
    refusals_.pop_front();
  }
}

void Core::State::welcome(Worker& worker, const input::Hello& in) {
  if (!worker.session) {
    worker.connected_at = clock_.wall();
  }
  workers_.connect(worker, in.session);
  worker.address = in.worker.address;
  worker.build = in.worker.build;
  worker.threads = std::clamp<std::uint32_t>(in.worker.threads, 1, wire::kThreadsPerWorker);
  worker.credits = std::clamp<std::uint32_t>(in.worker.max_bands, 1, wire::kBandsPerWorker);
  worker.draining = false;
  worker.doing.clear();
  worker.reason.clear();
  worker.heard_at = clock_.patience();
  if (!joined_.contains(worker.instance)) {
    emit(record::WorkerJoined{worker.instance});
  }
  await_rest_of_former(worker);
  forgive_losses(worker);
  for (const JobId id : active_) {
    for (Audit& audit : jobs_.at(id).audits) {
      audit.introduce(witness_of(worker));
    }
  }
  act(action::Welcome{in.session, worker.name,
                      static_cast<std::uint32_t>(options_.heartbeat_interval_s * 1000)});
  take_up(worker, in.worker.held);
  hunger_.update(worker);
}

void Core::State::take_up(Worker& worker, const std::vector<WorkerHello::Held>& held) {
  worker.dropping.clear();
  std::vector<LeaseId> dropped;
  for (const LeaseId id : worker.leases) {
    const Lease& lease = *leases_.find(id);
    const bool named = std::any_of(held.begin(), held.end(), [&](const WorkerHello::Held& h) {
      return h.lease == id && h.job == lease.job && h.band == lease.band;
    });
    if (!named) {
      dropped.push_back(id);
    }
  }
  end_all(dropped, Revoke::kNo);
  for (const WorkerHello::Held& h : held) {
    if (!take_up_one(worker, h)) {
      revoked_[*worker.session].push_back(h.lease);
      if (!h.finished) {
        worker.dropping.insert(h.lease);
      }
    }
  }
}

bool Core::State::take_up_one(Worker& worker, const WorkerHello::Held& held) {
  Job* job = find(held.job);
  Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(held.band);
  if (pass == nullptr || held.lease == kFree || held.lease == kStored ||
      !job->spec.may_be(held.work)) {
    return false;
  }
  if (const Lease* lease = leases_.find(held.lease)) {
    const bool same =
        lease->worker == worker.id && lease->job == held.job && lease->band == held.band;
    if (same) {
      leases_.find(held.lease)->advanced_at = clock_.patience();
      leases_.find(held.lease)->taken_up = true;
      act(action::Lease{*worker.session, held.lease, job->id, job->spec.manifest,
                        job->spec.settings, held.band, pass->tiles_of(held.band), 1, lease->audit});
    }
    return same;
  }
  // A finished band is better than one that somebody else has begun; an unfinished one is not.
  const bool wanted = held.finished ? !pass->coverage.wanted(held.band).empty()
                                    : pass->coverage.adoptable(held.band);
  if (!wanted || worker.leases.size() >= wire::kBandsPerWorker) {
    return false;
  }
  grant(worker, *job, *pass, held.band, held.lease);
  leases_.find(held.lease)->taken_up = true;
  return true;
}

void Core::State::on(const input::Heartbeat& in) {
  Worker* worker = workers_.by_session(in.session);
  if (worker == nullptr) {
    return;
  }
  worker->heard_at = clock_.patience();
  worker->doing = clean_text(in.doing, wire::kReasonBytes);
  std::erase_if(worker->dropping, [&](LeaseId id) {
    return std::none_of(in.leases.begin(), in.leases.end(),
                        [&](const LeaseProgress& progress) { return progress.lease == id; });
  });
  for (const LeaseProgress& progress : in.leases) {
    const auto place = std::find(worker->leases.begin(), worker->leases.end(), progress.lease);
    if (place == worker->leases.end()) {
      continue;
    }
    Lease& lease = *leases_.find(progress.lease);
    if (progress.rows_done > lease.rows_done || progress.prepared > lease.prepared) {
      lease.told_at = progress.rows_done > lease.rows_done ? clock_.wall() : lease.told_at;
      lease.rows_done = std::max(lease.rows_done, progress.rows_done);
      lease.prepared = std::max(lease.prepared, progress.prepared);
      advanced(*worker, static_cast<std::size_t>(place - worker->leases.begin()));
    }
  }
}

void Core::State::on(const input::Draining& in) {
  if (Worker* worker = workers_.by_session(in.session)) {
    worker->draining = true;
    worker->reason = clean_text(in.reason, wire::kReasonBytes);
    worker->heard_at = clock_.patience();
    hunger_.update(*worker);
  }
}

void Core::State::on(const input::Lost& in) {
  if (Worker* worker = workers_.by_session(in.session)) {
    lose(*worker, in.reason);
  }
}

void Core::State::lose(Worker& worker, const std::string& reason) {
  const std::vector<Losing> lost = in_hand(worker);
  worker.fell_silent = is_silent(worker);
  end_all(std::vector<LeaseId>(worker.leases), Revoke::kNo);
  if (!worker.quarantined) {
    worker.reason = clean_text(reason, wire::kReasonBytes);
  }
  worker.doing.clear();
  if (joined_.contains(worker.instance)) {
    emit(record::WorkerLeft{worker.instance});
  }
  workers_.disconnect(worker);
  hunger_.update(worker);
  add_losses(worker, lost);
  note_those_lost_together();
}

/// One that has not tried again for three times as long as it was told to wait is not there.
void Core::State::forget_refusals() {
  while (!refusals_.empty() && clock_.wall() - refusals_.front().at > kRefusalKept_s) {
    refusals_.pop_front();
  }
}

}  // namespace bandsaw::coordinator
