// An audit compares the results of several machines for the same band, a range of rows and samples.
// A result is added to each open audit of its rows. If a row differs from the stored row and no
// audit of that row is open, an audit is opened for it. Each audit that has a verdict is closed,
// and machines that were wrong are quarantined.

#include "coordinator/scheduler/trust/result_comparison.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/model/band_text.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the digests of the audit's rows; std::nullopt if the result does not have all of them.
std::optional<std::vector<std::uint64_t>> digests_for(const Band& audited,
                                                      const input::BandStored& in) {
  if (audited.samples != in.band.samples || audited.rows.first < in.band.rows.first ||
      audited.rows.last > in.band.rows.last) {
    return std::nullopt;
  }
  const auto first = in.row_digests.begin() + (audited.rows.first - in.band.rows.first);
  return std::vector(first, first + audited.rows.count());
}

/// Returns the rows of the band, stored by this process, that no second machine has confirmed.
std::vector<RowRange> not_audited(const Job& job, const Band& band, WorkerProcessId process) {
  std::vector<RowRange> rows;
  std::uint32_t next = band.rows.first;
  for (const auto& [done, by] : job.audited) {
    if (by == process && done.samples == band.samples && done.rows.last > next &&
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

void ResultComparison::open_audits(Job& job, const input::BandStored& in, const Reporter& reporter,
                                   const std::vector<RowRange>& rows) {
  const SchedulerOptions& options = context_.options;
  const double share = reporter.browser ? options.browser_audit_share : options.audit_share;
  if (!is_audited(job.spec, in.band, share)) {
    return;
  }
  for (const RowRange& range : rows) {
    for (const RowRange& left : not_audited(job, {in.band.samples, range}, reporter.process)) {
      const Band band{in.band.samples, left};
      if (job.audits.size() < Job::kMaxAudits) {
        job.audits.emplace_back(band, Audit::Result{reporter, *digests_for(band, in)});
      }
    }
  }
}

/// Opens an audit of the first row that differs from the stored row, unless an audit of that row is
/// open. This is needed for results that were not requested by an audit, such as those of backup
/// tasks.
void ResultComparison::open_dispute(Job& job, const Pass& pass, const input::BandStored& in) {
  const auto row = pass.digests.first_difference(in.band, in.row_digests);
  if (!row) {
    return;
  }
  const bool known = std::any_of(job.audits.begin(), job.audits.end(), [&](const Audit& audit) {
    return digests_for(audit.band(), in) && audit.band().rows.first <= *row &&
           *row < audit.band().rows.last;
  });
  if (!known) {
    const Reporter stored = context_.reporter_of(pass.process_of_row(in.band.samples, *row));
    job.audits.emplace_back(Band{in.band.samples, {*row, *row + 1}},
                            Audit::Result{stored, {*pass.digests.of(in.band.samples, *row)}});
    context_.jobs.mark_leasable(job);
  }
}

/// Journals the first row of the audit for which the other result differs from the stored result.
/// Journals nothing if the two results are equal.
void ResultComparison::note_dispute(const Job& job, const Audit& audit,
                                    const Audit::Result& other) {
  const Audit::Result& stored = audit.stored();
  const auto [ours, theirs] =
      std::mismatch(stored.digests.begin(), stored.digests.end(), other.digests.begin());
  if (ours == stored.digests.end() || job.disputes.size() >= Job::kMaxAudits) {
    return;
  }
  const Band& band = audit.band();
  const auto row = band.rows.first + static_cast<std::uint32_t>(ours - stored.digests.begin());
  const record::RowDisputed dispute{job.id,
                                    {band.samples, {row, row + 1}},
                                    {stored.reporter.process, stored.reporter.machine, *ours},
                                    {other.reporter.process, other.reporter.machine, *theirs}};
  if (std::find(job.disputes.begin(), job.disputes.end(), dispute) == job.disputes.end()) {
    context_.emit(dispute);
  }
}

void ResultComparison::reopen_disputes(Job& job) {
  // A claim is one of the two results of a journalled dispute. Makes an Audit::Result from it. The
  // machine's name is taken from the claim if the process has not connected in this epoch (run of
  // the coordinator).
  const auto result = [this](const record::RowDisputed::Claim& claim) {
    Reporter reporter = context_.reporter_of(claim.process);
    const bool away = reporter.machine.empty();
    if (away) {
      reporter.machine = claim.machine;
    }
    return Audit::Result{.reporter = std::move(reporter), .digests = {claim.digest}, .away = away};
  };
  for (const record::RowDisputed& one : job.disputes) {
    const Pass* pass = job.pass_of(one.band);
    if (pass == nullptr ||
        pass->process_of_row(one.band.samples, one.band.rows.first) != one.stored.process) {
      continue;
    }
    // An audit may already be open because the row was selected for audits. The result in that
    // audit may lack the machine's name, but the claim has the name. So the audit is replaced.
    std::erase_if(job.audits,
                  [&](const Audit& a) { return a.band() == one.band && !a.disputed(); });
    auto audit = std::find_if(job.audits.begin(), job.audits.end(),
                              [&](const Audit& a) { return a.band() == one.band; });
    if (audit == job.audits.end()) {
      audit = job.audits.insert(audit, Audit(one.band, result(one.stored)));
    }
    audit->add(result(one.other), /*requested=*/false);
  }
}

void ResultComparison::compare(Job& job, const Pass& pass, const input::BandStored& in,
                               const Reporter& reporter) {
  if (job.image_requested) {
    return;
  }
  open_dispute(job, pass, in);
  const Worker* worker = context_.workers.by_instance(in.instance);
  std::vector<LeaseId> rendered;
  std::vector<std::pair<Band, Audit::Result>> contradicted;
  for (Audit& audit : job.audits) {
    const auto digests = digests_for(audit.band(), in);
    if (!digests) {
      continue;
    }
    const Lease* lease = context_.leases.find(audit.lease);
    const bool requested = lease != nullptr && worker != nullptr && lease->worker == worker->id;
    const bool is_first = audit.result_of(reporter) == nullptr;
    // `before`: an earlier result of the same machine for this audit, if the new result differs.
    if (const auto before = audit.add({reporter, *digests}, requested)) {
      contradicted.emplace_back(audit.band(), *before);
    } else if (is_first) {
      note_dispute(job, audit, {reporter, *digests});
    }
    if (requested) {
      rendered.push_back(audit.lease);
    }
  }
  for (const LeaseId id : rendered) {
    ledger_.end_rendered(id);
  }
  for (const auto& [band, result] : contradicted) {
    quarantine_.impose(result.reporter,
                       absl::StrCat("returned pixels that differ from its earlier result for ",
                                    name_of(band), " of job ", job.id));
  }
  while (decide_one(job)) {
  }
}

/// Closes the first audit that has a verdict, and quarantines the machines that are wrong. Returns
/// false if no audit has a verdict.
bool ResultComparison::decide_one(Job& job) {
  for (auto audit = job.audits.begin(); audit != job.audits.end(); ++audit) {
    const auto verdict = audit->verdict(context_.only_browsers());
    if (!verdict) {
      continue;
    }
    const Band band = audit->band();
    const WorkerProcessId stored_by = audit->stored().reporter.process;
    if (audit->lease != 0) {
      ledger_.end(audit->lease, LeaseLedger::Revoke::kYes);
    }
    job.audits.erase(audit);
    if (verdict->stored_is_right) {
      context_.emit(record::BandAudited{job.id, band, stored_by});
    }
    for (const Audit::Result& wrong : verdict->wrong) {
      quarantine_.impose(wrong.reporter,
                         absl::StrCat("returned pixels that differ from the accepted result for ",
                                      name_of(band), " of job ", job.id));
    }
    return true;
  }
  return false;
}

}  // namespace bandsaw::coordinator
