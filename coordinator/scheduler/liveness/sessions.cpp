// hello() admits or refuses a worker, and reconciles the leases that the worker still holds with
// the leases that the scheduler has for it. disconnect() frees the leases of a worker that has left
// or fell silent.

#include "coordinator/scheduler/liveness/sessions.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

/// Times after which a refused worker may try again. kRetryRefusedMs is long, because a person has
/// to act first. kRetryFullMs is for a farm that is full, on which a place may become free at any
/// time. kKeepRefusal_s: how long a refusal is shown.
constexpr std::uint32_t kRetryRefusedMs = 60'000;
constexpr double kKeepRefusal_s = 3.0 * kRetryRefusedMs / 1000;
constexpr std::uint32_t kRetryFullMs = 10'000;

/// Returns the reason why a worker cannot serve on this farm, for the worker's log. The reason says
/// what differs and what a person has to do. std::nullopt: the worker can serve.
std::optional<std::string> incompatibility(const Compatibility& farm, const WorkerHello& worker) {
  const char* const advice =
      worker.protocol < farm.protocol || worker.pixel_version < farm.pixel_version
          ? "update the worker"
          : "update the coordinator";
  if (worker.protocol != farm.protocol) {
    return absl::StrCat("protocol ", worker.protocol, ", the coordinator's is ", farm.protocol,
                        ": build ", worker.build, "; ", advice);
  }
  if (worker.pixel_version != farm.pixel_version) {
    return absl::StrCat("pixel version ", worker.pixel_version, ", the coordinator's is ",
                        farm.pixel_version, ": build ", worker.build, "; ", advice);
  }
  if (worker.canary != farm.canary) {
    return absl::StrFormat(
        "its test render gives other pixels (canary %016x, the coordinator's is %016x): build %s; "
        "compile both from the same sources",
        worker.canary, farm.canary, worker.build);
  }
  return std::nullopt;
}

}  // namespace

void Sessions::hello(const input::Hello& in) {
  if (const auto why = incompatibility(context_.options.compatibility, in.worker)) {
    refuse(in, *why);
    return;
  }
  if (in.worker.browser && context_.options.browsers == Browsers::kNone) {
    refuse(in, "this farm takes no browsers: it was started with --browsers none");
    return;
  }
  if (in.worker.browser && context_.quarantine.too_many_browsers()) {
    refuse(in,
           absl::StrCat("too many browsers returned wrong pixels, ", QuarantineList::kMaxBrowsers,
                        ": take the link back with `bandsaw link --revoke`; browsers are admitted "
                        "again when no job is active"));
    return;
  }
  if (const auto named = context_.quarantine.missing_name(in.worker)) {
    context_.emit(*named);
  }
  if (const auto why = context_.quarantine.reason_against(
          in.worker.instance, in.worker.browser ? "" : in.worker.name)) {
    context_.act(action::Refuse{in.session, *why, kRetryRefusedMs});
    return;
  }
  Worker* worker = context_.workers.by_instance(in.worker.instance);
  const bool connected = worker != nullptr && worker->session;
  if (worker != nullptr && worker->browser != in.worker.browser) {
    refuse(in, "another worker has this instance id");
    return;
  }
  if (!connected && is_full(in.worker)) {
    context_.act(action::Refuse{in.session,
                                absl::StrCat("the farm is full: ", wire::kWorkers,
                                             " workers, at most half of them browsers"),
                                kRetryFullMs});
    return;
  }
  if (connected && *worker->session != in.session) {
    context_.act(action::Close{*worker->session, "the worker has opened another session"});
  }
  if (worker == nullptr) {
    worker =
        &context_.workers.add(in.worker.instance, in.worker.reported_name(), in.worker.browser);
  }
  admit(*worker, in);
}

bool Sessions::is_full(const WorkerHello& worker) const {
  return context_.workers.connected() >= wire::kWorkers ||
         (worker.browser && context_.workers.connected_browsers() >= wire::kWorkers / 2);
}

void Sessions::refuse(const input::Hello& in, const std::string& reason) {
  std::erase_if(refusals_, [&](const Refusal& r) { return r.instance == in.worker.instance; });
  WorkerView view;
  view.name = in.worker.reported_name();
  view.state = "refused";
  view.reason = clean_text(reason, wire::kReasonBytes);
  view.address = in.worker.address;
  view.build = in.worker.build;
  view.threads = in.worker.threads;
  view.browser = in.worker.browser;
  refusals_.push_back({in.worker.instance, std::move(view), context_.clock.wall()});
  if (refusals_.size() > kMaxRefusals) {
    refusals_.pop_front();
  }
  context_.act(action::Refuse{in.session, reason, kRetryRefusedMs});
}

void Sessions::admit(Worker& worker, const input::Hello& in) {
  if (!worker.session) {
    worker.connected_at = context_.clock.wall();
  }
  context_.workers.connect(worker, in.session);
  worker.address = in.worker.address;
  worker.build = in.worker.build;
  worker.threads = std::clamp<std::uint32_t>(in.worker.threads, 1, wire::kThreadsPerWorker);
  worker.credits = std::clamp<std::uint32_t>(in.worker.max_bands, 1, wire::kBandsPerWorker);
  worker.memory_bytes = in.worker.memory_bytes;
  worker.draining = false;
  worker.quarantined = false;
  worker.doing.clear();
  worker.reason.clear();
  worker.heard_at = context_.clock.timeout_clock();
  if (!context_.joined.contains(worker.instance)) {
    context_.emit(record::WorkerJoined{worker.instance, worker.browser});
  }
  barrier_.worker_connected(worker);
  crashes_.worker_connected(worker);
  for (const JobId id : context_.jobs.active()) {
    for (Audit& audit : context_.jobs.at(id).audits) {
      audit.identify(worker.reporter());
    }
  }
  context_.act(
      action::Welcome{in.session, worker.name,
                      static_cast<std::uint32_t>(context_.options.heartbeat_interval_s * 1000)});
  reconcile_leases(worker, in.worker.held);
  context_.available.update(worker);
}

/// `held`: the leases that the worker names in its Hello. Ends the worker's leases that are not in
/// `held`, and revokes those in `held` that the worker may not keep.
void Sessions::reconcile_leases(Worker& worker, const std::vector<WorkerHello::Held>& held) {
  worker.revoked.clear();
  std::vector<LeaseId> dropped;
  for (const LeaseId id : worker.leases) {
    const Lease& lease = *context_.leases.find(id);
    const bool named = std::any_of(held.begin(), held.end(), [&](const WorkerHello::Held& h) {
      return h.lease == id && h.job == lease.job && h.band == lease.band;
    });
    if (!named) {
      dropped.push_back(id);
    }
  }
  ledger_.end_all(dropped, LeaseLedger::Revoke::kNo);
  for (const WorkerHello::Held& h : held) {
    if (!keep_lease(worker, h)) {
      context_.revoke(*worker.session, h.lease);
      if (!h.finished) {
        worker.revoked.insert(h.lease);
      }
    }
  }
}

/// Confirms a lease of this epoch (run of the coordinator). Adopts a lease of an earlier epoch,
/// that is, grants it again with its id, if rows of its band are wanted (not stored). A lease of a
/// finished band is adopted even if other workers hold leases of these rows. A lease of an
/// unfinished band is adopted only if no other worker holds a lease of these rows. Returns false if
/// the worker must drop the lease.
bool Sessions::keep_lease(Worker& worker, const WorkerHello::Held& held) {
  Job* job = context_.jobs.find(held.job);
  Pass* pass = job == nullptr || is_final(job->state) ? nullptr : job->pass_of(held.band);
  if (pass == nullptr || held.lease == kFree || held.lease == kStored ||
      !job->spec.may_be(held.work)) {
    return false;
  }
  if (Lease* lease = context_.leases.find(held.lease)) {
    // Two epochs can have given the same id to different bands.
    const bool same =
        lease->worker == worker.id && lease->job == held.job && lease->band == held.band;
    if (same) {
      lease->advanced_at = context_.clock.timeout_clock();
      lease->in_hello = true;
      context_.act(action::Lease{*worker.session, held.lease, job->id, job->spec.manifest,
                                 job->spec.settings, held.band, pass->tiles_of(held.band),
                                 /*attempt=*/1, lease->audit});
    }
    return same;
  }
  const bool wanted = held.finished ? !pass->coverage.wanted(held.band).empty()
                                    : pass->coverage.adoptable(held.band);
  if (!wanted || worker.leases.size() >= wire::kBandsPerWorker) {
    return false;
  }
  ledger_.grant(worker, *job, *pass, held.band, held.lease);
  context_.leases.find(held.lease)->in_hello = true;
  return true;
}

void Sessions::heartbeat(const input::Heartbeat& in) {
  Worker* worker = context_.workers.by_session(in.session);
  if (worker == nullptr) {
    return;
  }
  worker->heard_at = context_.clock.timeout_clock();
  worker->doing = clean_text(in.doing, wire::kReasonBytes);
  std::erase_if(worker->revoked, [&](LeaseId id) {
    return std::none_of(in.leases.begin(), in.leases.end(),
                        [&](const LeaseProgress& progress) { return progress.lease == id; });
  });
  for (const LeaseProgress& progress : in.leases) {
    const auto place = std::find(worker->leases.begin(), worker->leases.end(), progress.lease);
    if (place == worker->leases.end()) {
      continue;
    }
    Lease& lease = *context_.leases.find(progress.lease);
    if (progress.rows_done > lease.rows_done || progress.prepared > lease.prepared) {
      if (progress.rows_done > lease.rows_done) {
        lease.progress_at = context_.clock.wall();
      }
      lease.rows_done = std::max(lease.rows_done, progress.rows_done);
      lease.prepared = std::max(lease.prepared, progress.prepared);
      ledger_.note_progress(*worker, static_cast<std::size_t>(place - worker->leases.begin()));
    }
  }
}

void Sessions::draining(const input::Draining& in) {
  if (Worker* worker = context_.workers.by_session(in.session)) {
    worker->draining = true;
    worker->reason = clean_text(in.reason, wire::kReasonBytes);
    worker->heard_at = context_.clock.timeout_clock();
    context_.available.update(*worker);
  }
}

void Sessions::ended(const input::SessionEnded& in) {
  if (Worker* worker = context_.workers.by_session(in.session)) {
    disconnect(*worker, in.reason);
  }
}

void Sessions::disconnect(Worker& worker, const std::string& reason) {
  const std::vector<HeldBand> held = crashes_.held_bands(worker);
  worker.fell_silent = context_.is_silent(worker);
  ledger_.end_all(std::vector<LeaseId>(worker.leases), LeaseLedger::Revoke::kNo);
  if (!worker.quarantined) {
    worker.reason = clean_text(reason, wire::kReasonBytes);
  }
  worker.doing.clear();
  if (context_.joined.contains(worker.instance)) {
    context_.emit(record::WorkerLeft{worker.instance});
  }
  context_.workers.disconnect(worker);
  context_.available.update(worker);
  crashes_.worker_lost(worker, held);
  barrier_.worker_lost();
}

void Sessions::check_silence() {
  const double timeout_s = context_.options.heartbeat_timeout_s;
  std::vector<WorkerId> silent;
  for (const auto& [id, worker] : context_.workers.all()) {
    if (worker.session && context_.clock.timeout_clock() - worker.heard_at > timeout_s) {
      silent.push_back(id);
    }
  }
  for (const WorkerId id : silent) {
    Worker& worker = *context_.workers.by_id(id);
    const std::string reason = absl::StrCat("no message for ", timeout_s, " s");
    context_.act(action::Close{*worker.session, reason});
    disconnect(worker, reason);
  }
}

void Sessions::forget_refusals() {
  while (!refusals_.empty() && context_.clock.wall() - refusals_.front().at > kKeepRefusal_s) {
    refusals_.pop_front();
  }
}

}  // namespace bandsaw::coordinator
