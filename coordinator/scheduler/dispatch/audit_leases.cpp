// Chooses an open audit (the second rendering of a stored band, to compare) for a worker and leases
// it. A machine that has already returned a result for the band renders it again only if the
// results differ and no other machine can decide which one is right.

#include "coordinator/scheduler/dispatch/audit_leases.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace bandsaw::coordinator {

bool AuditLeases::may_render(const Worker& worker, const Job& job, const Audit& audit) const {
  // Returns true if the worker `one` may render the band, as long as the results that its machine
  // has returned are not considered.
  const auto able = [&](const Worker& one) {
    return one.eligible() && eligibility_.may_audit(one, job) &&
           !audit.unable.contains(one.machine()) &&
           (!one.browser || (context_.only_browsers() && audit.only_browsers()));
  };
  if (!able(worker)) {
    return false;
  }
  const Audit::Result* result = audit.result_of(worker.reporter());
  if (result == nullptr) {
    return true;
  }
  const auto& all = context_.workers.all();
  return audit.disputed() && !result->repeated &&
         std::none_of(all.begin(), all.end(), [&](const auto& entry) {
           return able(entry.second) && audit.result_of(entry.second.reporter()) == nullptr;
         });
}

Audit* AuditLeases::next_for(const Worker& worker, Job& job) const {
  const auto audit = std::find_if(job.audits.begin(), job.audits.end(), [&](const Audit& a) {
    return a.lease == 0 && may_render(worker, job, a);
  });
  return audit == job.audits.end() ? nullptr : &*audit;
}

void AuditLeases::grant(Worker& worker, Job& job, Audit& audit, std::uint32_t end_row) {
  std::optional<Audit> rest;
  if (end_row < audit.band().rows.last && !audit.disputed() &&
      job.audits.size() < Job::kMaxAudits) {
    rest = audit.split_at(end_row);
  }
  audit.lease = context_.leases.new_id();
  audit.given.insert(worker.machine());
  ledger_.add(
      worker, job, *job.pass_of(audit.band()),
      {.id = audit.lease, .job = job.id, .worker = worker.id, .band = audit.band(), .audit = true});
  if (rest) {
    job.audits.push_back(*std::move(rest));
    context_.jobs.mark_leasable(job);
  }
}

void AuditLeases::give_up(const Lease& lease, const Worker& worker, const std::string& reason) {
  if (Audit* audit = context_.jobs.at(lease.job).audit_under(lease.id)) {
    audit->unable.insert(worker.machine());
  }
  context_.act(action::LogFailure{lease.job, lease.band, worker.name, reason});
  ledger_.end(lease.id, LeaseLedger::Revoke::kYes);
}

bool AuditLeases::block(const Job& job) const {
  const auto& workers = context_.workers.all();
  return std::any_of(job.audits.begin(), job.audits.end(), [&](const Audit& audit) {
    return audit.lease != 0 || audit.doubtful() || barrier_.active() ||
           std::any_of(workers.begin(), workers.end(),
                       [&](const auto& entry) { return may_render(entry.second, job, audit); });
  });
}

}  // namespace bandsaw::coordinator
