// What always holds between two inputs, each as a sentence of what is broken.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/core/state.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {

std::optional<std::string> Core::State::broken_invariant() const {
  if (auto broken = broken_leases()) {
    return broken;
  }
  if (auto broken = broken_workers()) {
    return broken;
  }
  for (const auto& [id, job] : jobs_) {
    if (auto broken = broken_job(job)) {
      return absl::StrCat("job ", id, ": ", *broken);
    }
  }
  if (!revoked_.empty() || !step_.records.empty() || !step_.actions.empty()) {
    return "a step ended with things left to say";
  }
  if (active_.size() > wire::kActiveJobs || workers_.connected() > wire::kWorkers) {
    return "there are more jobs or workers than the limits allow";
  }
  return std::nullopt;
}

std::optional<std::string> Core::State::broken_leases() const {
  for (const auto& [id, lease] : leases_.all()) {
    const Job* job = find(lease.job);
    if (job == nullptr || is_final(job->state) || !job->leases.contains(id)) {
      return absl::StrCat("lease ", id, " is of a job that does not have it");
    }
    const Pass* pass = job->pass_of(lease.band);
    if (pass == nullptr ||
        (lease.copy_of == 0 && !lease.audit) != pass->coverage.holds(lease.band, id)) {
      return absl::StrCat("lease ", id, " has nothing of its band, or is a copy that has");
    }
    const auto is_its_audit = [&id = id, &lease = lease](const Audit& a) {
      return a.lease == id && a.band() == lease.band;
    };
    if (lease.audit && std::count_if(job->audits.begin(), job->audits.end(), is_its_audit) != 1) {
      return absl::StrCat("lease ", id, " is of an audit that its job does not know");
    }
    if ((lease.copy_of != 0) != job->copies.contains(id)) {
      return absl::StrCat("lease ", id, " is a copy that its job does not know, or the reverse");
    }
    if (const Lease* of = leases_.find(lease.copy_of);
        lease.copy_of != 0 &&
        (of == nullptr || of->copy_of != 0 || of->worker == lease.worker || of->job != lease.job ||
         of->band.samples != lease.band.samples || lease.band.rows.first < of->band.rows.first ||
         lease.band.rows.last > of->band.rows.last)) {
      return absl::StrCat("lease ", id, " is a copy of nothing that it is a part of");
    }
    const Worker* worker = workers_.by_id(lease.worker);
    if (worker == nullptr || !worker->session ||
        std::count(worker->leases.begin(), worker->leases.end(), id) != 1) {
      return absl::StrCat("lease ", id, " is not of a live session");
    }
  }
  return std::nullopt;
}

std::optional<std::string> Core::State::broken_workers() const {
  std::size_t hungry = 0;
  std::uint64_t threads = 0;
  for (const auto& [id, worker] : workers_.all()) {
    for (const LeaseId lease : worker.leases) {
      if (leases_.find(lease) == nullptr) {
        return absl::StrCat(worker.name, " has a lease that nobody knows");
      }
    }
    if (worker.leases.size() > wire::kBandsPerWorker) {
      return absl::StrCat(worker.name, " has too many leases");
    }
    if (worker.hungry() != hunger_.contains({worker.leases.size(), id})) {
      return absl::StrCat(worker.name, " has spare credits and is passed over, or the reverse");
    }
    hungry += worker.hungry() ? 1 : 0;
    threads += worker.eligible() ? worker.threads : 0;
    if (worker.session && !joined_.contains(worker.instance)) {
      return absl::StrCat(worker.name, " is connected and not journalled");
    }
  }
  if (hungry != hunger_.size() || threads != hunger_.threads()) {
    return "workers that are gone are counted as waiting for work";
  }
  return std::nullopt;
}

std::optional<std::string> Core::State::broken_job(const Job& job) const {
  if (is_final(job.state) == active_.contains(job.id)) {
    return "it is counted as active and final, or as neither";
  }
  if (is_final(job.state)) {
    return job.leases.empty() && job.passes.empty() ? std::nullopt
                                                    : std::optional("it is final and has leases");
  }
  if (job.state == JobState::kFinishing && (!job.complete() || !job.leases.empty())) {
    return "it is finishing and not all of it is there";
  }
  if (job.state == JobState::kRunning && job.complete() && job.audits.empty()) {
    return "all of it is there and it is not finishing";
  }
  for (const Audit& audit : job.audits) {
    if (audit.lease != 0 && !job.leases.contains(audit.lease)) {
      return "a band is rendered a second time by nobody";
    }
    if (quarantined_.contains(audit.stored().witness.renderer)) {
      return "it has rows of a machine that is under quarantine";
    }
  }
  if (job.state == JobState::kRunning && (job.any_free() || job.audit_waits()) &&
      !leasable_.contains(rank(job))) {
    return "it has free rows and is passed over";
  }
  if (job.state != JobState::kRunning && leasable_.contains(rank(job))) {
    return "it is leased out and does not run";
  }
  if (job.held && job.state == JobState::kRunning) {
    return "a person paused it and it runs";
  }
  if (job.passes.empty() || (job.fixed && job.planned_samples() > *job.fixed)) {
    return "its passes are not the ones its stop rule asks for";
  }
  std::uint64_t end = 0;
  for (const Pass& pass : job.passes) {
    if (pass.samples.first != end || !is_node(pass.samples)) {
      return absl::StrCat("the pass after sample ", end, " does not follow it as a node");
    }
    end = pass.samples.last;
    if (auto broken = broken_pass(job, pass)) {
      return broken;
    }
  }
  return std::nullopt;
}

std::optional<std::string> Core::State::broken_pass(const Job& job, const Pass& pass) const {
  std::optional<std::string> broken;
  auto partition = pass.coverage.check([&](LeaseId id, const Band& cell) {
    const Lease* lease = leases_.find(id);
    if (lease == nullptr || lease->job != job.id || lease->band.samples != cell.samples ||
        cell.rows.first < lease->band.rows.first || cell.rows.last > lease->band.rows.last) {
      broken = absl::StrCat("row ", cell.rows.first, " is leased as ", id,
                            ", and that lease is not of it");
    }
  });
  return broken ? broken : std::move(partition);
}

}  // namespace bandsaw::coordinator
