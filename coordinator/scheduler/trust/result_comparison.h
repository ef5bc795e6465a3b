#pragma once

// Opens audits of stored bands, and compares results with the rows that are stored. An audit is the
// comparison of the results of two machines for the same band, a range of rows and samples
// (model/audit.h).

#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/trust/quarantine.h"

namespace bandsaw::coordinator {

class ResultComparison {
 public:
  ResultComparison(Context& context, LeaseLedger& ledger, Quarantine& quarantine)
      : context_(context), ledger_(ledger), quarantine_(quarantine) {}

  /// If the band is selected for audits, opens audits of `rows`. These are rows of the band that
  /// were just stored.
  void open_audits(Job& job, const input::BandStored& in, const Reporter& reporter,
                   const std::vector<RowRange>& rows);
  /// Compares a result with the stored digests of its rows. Adds it to the audits of these rows,
  /// opens an audit for a row that differs, and quarantines machines that are proved wrong. No
  /// effect once the job's image was requested, because its rows cannot be replaced any more.
  void compare(Job& job, const Pass& pass, const input::BandStored& in, const Reporter& reporter);
  /// After a restart: opens an audit again for each journalled dispute (two machines returned
  /// different digests) about a row that is stored. MUST be called after the job's bands on disk
  /// were replayed.
  void reopen_disputes(Job& job);

 private:
  /// Opens an audit of the first row that differs from the stored row, if no audit of it is open.
  void open_dispute(Job& job, const Pass& pass, const input::BandStored& in);
  /// Journals that `other` differs from the stored result of the audit, if it does.
  void note_dispute(const Job& job, const Audit& audit, const Audit::Result& other);
  /// Closes the first audit that has a verdict (it is known which machines are wrong), and
  /// quarantines these machines. Returns false if no audit has a verdict.
  bool decide_one(Job& job);

  Context& context_;
  LeaseLedger& ledger_;
  Quarantine& quarantine_;
};

}  // namespace bandsaw::coordinator
