// Bands that two machines render, and results that differ (audit.h).

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/core/band_text.h"
#include "coordinator/core/renderer.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {
namespace {

/// The result as far as the audit's rows go; nothing when it has not all of them.
std::optional<std::vector<std::uint64_t>> digests_for(const Band& audited,
                                                      const input::BandStored& in) {
  if (audited.samples != in.band.samples || audited.rows.first < in.band.rows.first ||
      audited.rows.last > in.band.rows.last) {
    return std::nullopt;
  }
  const auto first = in.row_digests.begin() + (audited.rows.first - in.band.rows.first);
  return std::vector(first, first + audited.rows.count());
}

/// The band without the rows that a second machine has vouched for.
std::vector<RowRange> not_audited(const Job& job, const Band& band, std::uint64_t renderer) {
  std::vector<RowRange> rows;
  std::uint32_t next = band.rows.first;
  for (const auto& [done, by] : job.audited) {
    if (by == renderer && done.samples == band.samples && done.rows.last > next &&
        done.rows.first < band.rows.last) {
      if (done.rows.first > next) {
        rows.push_back({next, done.rows.first});
      }
      next = done.rows.last;
    }
  }
  if (next < band.rows.last) {
    rows.push_back({next, band.rows.last});
  }
  return rows;
}

}  // namespace

Witness Core::State::witness_of(const input::BandStored& in) const {
  if (in.instance.empty()) {
    return {.renderer = in.renderer, .machine = {}};
  }
  const Worker* worker = workers_.by_instance(in.instance);
  return worker == nullptr ? Witness{.renderer = renderer_of(in.instance), .machine = {}}
                           : witness_of(*worker);
}

Witness Core::State::witness_of(const Worker& worker) {
  return {.renderer = worker.renderer, .machine = worker.said};
}

Witness Core::State::witness_of(std::uint64_t renderer) const {
  const Worker* worker = workers_.by_renderer(renderer);
  return worker == nullptr ? Witness{.renderer = renderer, .machine = {}} : witness_of(*worker);
}

void Core::State::open_audits(Job& job, const input::BandStored& in, const Witness& witness,
                              const std::vector<RowRange>& rows) {
  if (!is_audited(job.spec, in.band, options_.audit_share)) {
    return;
  }
  for (const RowRange& range : rows) {
    for (const RowRange& left : not_audited(job, {in.band.samples, range}, witness.renderer)) {
      const Band band{in.band.samples, left};
      if (job.audits.size() < Job::kAuditsKept) {
        job.audits.emplace_back(band, Audit::Claim{witness, *digests_for(band, in)});
      }
    }
  }
}

/// A result of rows that are there may differ though nobody has asked for it.
void Core::State::open_dispute(Job& job, const Pass& pass, const input::BandStored& in) {
  const auto row = pass.digests.first_difference(in.band, in.row_digests);
  if (!row) {
    return;
  }
  const bool known = std::any_of(job.audits.begin(), job.audits.end(), [&](const Audit& audit) {
    return digests_for(audit.band(), in) && audit.band().rows.first <= *row &&
           *row < audit.band().rows.last;
  });
  if (!known) {
    const Witness stored = witness_of(pass.renderer_of_row(in.band.samples, *row));
    job.audits.emplace_back(Band{in.band.samples, {*row, *row + 1}},
                            Audit::Claim{stored, {*pass.digests.of(in.band.samples, *row)}});
    touch(job);
  }
}

void Core::State::weigh(Job& job, const Pass& pass, const input::BandStored& in,
                        const Witness& witness) {
  if (job.image_asked) {
    return;  // what is in the image stays there: nothing is left to decide
  }
  open_dispute(job, pass, in);
  const Worker* worker = workers_.by_instance(in.instance);
  std::vector<LeaseId> answered;
  std::vector<std::pair<Band, Audit::Claim>> contradicted;
  for (Audit& audit : job.audits) {
    const auto digests = digests_for(audit.band(), in);
    if (!digests) {
      continue;
    }
    const Lease* lease = leases_.find(audit.lease);
    const bool asked = lease != nullptr && worker != nullptr && lease->worker == worker->id;
    if (const auto before = audit.hear({witness, *digests}, asked)) {
      contradicted.emplace_back(audit.band(), *before);
    }
    if (asked) {
      answered.push_back(audit.lease);
    }
  }
  for (const LeaseId id : answered) {
    // The answer to a Hello may reach the worker after it has dropped this band.
    end_lease(id, leases_.find(id)->taken_up ? Revoke::kYes : Revoke::kNo);
  }
  for (const auto& [band, claim] : contradicted) {
    quarantine(claim.witness, absl::StrCat("returned other pixels than it did before for ",
                                           name_of(band), " of job ", job.id));
  }
  while (judge_one(job)) {
  }
}

/// Whether an audit could be decided. Those who were wrong are quarantined.
bool Core::State::judge_one(Job& job) {
  for (auto audit = job.audits.begin(); audit != job.audits.end(); ++audit) {
    const auto verdict = audit->verdict();
    if (!verdict) {
      continue;
    }
    const Band band = audit->band();
    const std::uint64_t stored_by = audit->stored().witness.renderer;
    if (audit->lease != 0) {
      end_lease(audit->lease, Revoke::kYes);
    }
    job.audits.erase(audit);
    if (verdict->stored_is_right) {
      emit(record::BandAudited{job.id, band, stored_by});
    }
    for (const Audit::Claim& liar : verdict->liars) {
      quarantine(liar.witness, absl::StrCat("returned other pixels than two others for ",
                                            name_of(band), " of job ", job.id));
    }
    return true;
  }
  return false;
}

/// Another machine than those that have said something; those once more when there is nobody else
/// to decide between them.
bool Core::State::may_audit(const Worker& worker, const Job& job, const Audit& audit) const {
  if (!worker.eligible() || !may_render(worker, job) || audit.unable.contains(worker.said)) {
    return false;
  }
  const Audit::Claim* claim = audit.claim_of(witness_of(worker));
  return claim == nullptr ||
         (audit.disputed() && !claim->repeated &&
          std::none_of(workers_.all().begin(), workers_.all().end(), [&](const auto& entry) {
            const Worker& other = entry.second;
            return other.eligible() && may_render(other, job) &&
                   !audit.unable.contains(other.said) &&
                   audit.claim_of(witness_of(other)) == nullptr;
          }));
}

Audit* Core::State::audit_for(const Worker& worker, Job& job) const {
  const auto audit = std::find_if(job.audits.begin(), job.audits.end(), [&](const Audit& a) {
    return a.lease == 0 && may_audit(worker, job, a);
  });
  return audit == job.audits.end() ? nullptr : &*audit;
}

Audit* Core::State::audit_of(const Lease& lease) {
  std::vector<Audit>& audits = jobs_.at(lease.job).audits;
  const auto audit = std::find_if(audits.begin(), audits.end(),
                                  [&](const Audit& a) { return a.lease == lease.id; });
  return audit == audits.end() ? nullptr : &*audit;
}

/// As much of it as is a band for this worker now; what is left waits for the next one.
void Core::State::grant_audit(Worker& worker, Job& job, Audit& audit) {
  std::optional<Audit> rest;
  const std::uint32_t end = sized(job, worker, audit.band()).rows.last;
  if (end < audit.band().rows.last && !audit.disputed() && job.audits.size() < Job::kAuditsKept) {
    rest = audit.split_at(end);
  }
  audit.lease = leases_.new_id();
  audit.given.insert(worker.said);
  hand_over(
      worker, job, *job.pass_of(audit.band()),
      {.id = audit.lease, .job = job.id, .worker = worker.id, .band = audit.band(), .audit = true});
  if (rest) {
    job.audits.push_back(*std::move(rest));  // `audit` is not where it was
    touch(job);
  }
}

/// One machine that cannot render a band again says nothing of the job: others are asked, or none.
void Core::State::give_up_audit(const Lease& lease, const Worker& worker,
                                const std::string& reason) {
  if (Audit* audit = audit_of(lease)) {
    audit->unable.insert(worker.said);
  }
  act(action::Faulted{lease.job, lease.band, worker.name, reason});
  end_lease(lease.id, Revoke::kYes);
}

/// Whether what is stored of a job may turn out to be wrong yet. An audit that nobody is there for
/// does not hold a job up, a dispute does.
bool Core::State::audits_hold(const Job& job) const {
  return std::any_of(job.audits.begin(), job.audits.end(), [&](const Audit& audit) {
    return audit.lease != 0 || audit.disputed() || waits_for_former() ||
           std::any_of(workers_.all().begin(), workers_.all().end(),
                       [&](const auto& entry) { return may_audit(entry.second, job, audit); });
  });
}

/// What a job with nothing left to render waits for.
std::string Core::State::audit_reason(const Job& job) const {
  for (const Audit& audit : job.audits) {
    if (audit.disputed() && audit.lease == 0) {
      const std::string names =
          absl::StrJoin(audit.claims(), ", ", [this](std::string* out, const Audit::Claim& claim) {
            absl::StrAppend(out, shown_name(claim.witness));
          });
      return absl::StrCat(names, " returned different pixels for ", name_of(audit.band()),
                          "; another machine must decide: start a worker on one, or say which is "
                          "wrong with: bandsaw quarantine NAME");
    }
  }
  return absl::StrCat(job.audits.size(), job.audits.size() == 1 ? " band is" : " bands are",
                      " being rendered a second time, by another machine, to compare");
}

}  // namespace bandsaw::coordinator
