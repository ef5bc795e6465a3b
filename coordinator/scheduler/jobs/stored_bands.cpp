// A band is a range of rows and samples. store() marks the rows of a band as stored and counts the
// rows that were not stored before; free_damaged() makes the rows of a band that is damaged on disk
// free again.

#include "coordinator/scheduler/jobs/stored_bands.h"

#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/model/band_text.h"

namespace bandsaw::coordinator {

Coverage::Change StoredBands::store(Job& job, Pass& pass, const input::BandStored& in,
                                    const Reporter& reporter) {
  Coverage::Change change = pass.coverage.assign(in.band, kStored);
  job.bands_on_disk = true;
  if (change.rows.empty()) {
    return change;
  }
  pass.digests.keep(in.band, change.rows, in.row_digests);
  job.clear_suspicion(in.band);
  std::uint64_t samples = 0;
  for (const RowRange& range : change.rows) {
    samples += job.samples_of({in.band.samples, range});
  }
  pass.add_stored(reporter.process, in.band, change.rows, {samples, in.counters, in.cpu_s});
  job.throughput.add(context_.clock.wall(), static_cast<double>(samples));
  add_share(job, in, reporter.process, samples);
  job.count_complete_passes();
  context_.jobs.mark_leasable(job);
  return change;
}

/// Adds these samples to the share of the job that the process has rendered.
void StoredBands::add_share(Job& job, const input::BandStored& in, WorkerProcessId process,
                            std::uint64_t samples) {
  if (process == 0 || (job.shares.size() >= Job::kMaxShares && !job.shares.contains(process))) {
    return;
  }
  WorkerShare& share = job.shares[process];
  share.process = process;
  share.samples += samples;
  share.cpu_s += in.cpu_s;
  if (const Worker* worker = context_.workers.by_instance(in.instance)) {
    share.name = worker->name;
  }
}

void StoredBands::free_damaged(Job& job, const input::BandsDamaged& in) {
  for (const auto& [band, process] : in.bands) {
    const Pass* pass = job.pass_of(band);
    if (pass == nullptr || !pass->has_stored(band, process)) {
      continue;  // the band has already been freed
    }
    close_audits(job, band, process);
    context_.emit(record::BandLost{job.id, band, process});
    job.damage = absl::StrCat(
        ++job.damaged_bands,
        " of its bands were damaged on the coordinator's disk and are rendered again; the last: ",
        name_of(band), "; check the disk");
  }
  job.image_requested = false;
  if (job.state == JobState::kFinishing) {
    context_.emit(record::StateChanged{job.id, JobState::kRunning, ""});
  }
  context_.jobs.mark_leasable(job);
}

/// Ends the audits (second renderings, to compare) of a band that the process had stored. The
/// stored result is lost, so nothing is left to compare with.
void StoredBands::close_audits(Job& job, const Band& band, WorkerProcessId process) {
  const auto is_of_it = [&](const Audit& audit) {
    return audit.stored().reporter.process == process && overlap(audit.band(), band);
  };
  std::vector<LeaseId> useless;
  for (const Audit& audit : job.audits) {
    if (is_of_it(audit) && audit.lease != 0) {
      useless.push_back(audit.lease);
    }
  }
  ledger_.end_all(useless, LeaseLedger::Revoke::kYes);
  std::erase_if(job.audits, is_of_it);
}

// Journals BandLost for each audited band of which some rows are not stored, because they are
// missing from the band log. Bands of quarantined processes are left out, because their pixels are
// never used.
void StoredBands::note_missing_audited(const Job& job) {
  const auto audited = job.audited;  // a copy, because BandLost removes entries of job.audited
  for (const auto& [band, process] : audited) {
    const Pass* pass = job.pass_of(band);
    if (pass != nullptr && !context_.quarantine.contains(process) &&
        !pass->coverage.wanted(band).empty()) {
      context_.emit(record::BandLost{job.id, band, process});
    }
  }
}

}  // namespace bandsaw::coordinator
