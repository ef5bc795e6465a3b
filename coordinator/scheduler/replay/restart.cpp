// After a restart, the bands on disk (ranges of rows and samples that workers have rendered) are
// added one by one. Then finish() begins the reconnect barrier: nothing is leased until the former
// workers have reconnected or a grace time is over. It opens the audits of disputed rows again (two
// machines returned different pixels for such a row), and compares the bands that were rendered
// twice. At the end it continues the sequences (jobs of many frames), and each job that is not
// final.

#include "coordinator/scheduler/replay/restart.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"

namespace bandsaw::coordinator {

void Restart::add_band(const input::BandStored& band) {
  Job* job = context_.jobs.find(band.job);
  if (job == nullptr) {
    return;
  }
  job->bands_on_disk = true;
  Pass* pass = is_final(job->state) ? nullptr : job->pass_of(band.band);
  const Reporter reporter = context_.reporter_of(band);
  if (pass == nullptr || band.row_digests.size() != band.band.rows.count() ||
      context_.quarantine.contains(reporter.process)) {
    return;
  }
  // True if no band that was added before stored any of these rows.
  const bool is_new = pass->coverage.wanted(band.band) == std::vector<RowRange>{band.band.rows};
  const Coverage::Change change = bands_.store(*job, *pass, band, reporter);
  comparison_.open_audits(*job, band, reporter, change.rows);
  if (!is_new) {
    duplicates_.push_back(band);
  }
}

void Restart::note_damage(JobId id, std::uint64_t bytes) {
  if (Job* job = context_.jobs.find(id); job != nullptr && !is_final(job->state)) {
    job->damage = absl::StrCat(bytes,
                               " bytes of its bands on the coordinator's disk were damaged, or not "
                               "written to the end; their rows are rendered again");
  }
}

void Restart::compare_duplicates() {
  for (const input::BandStored& band : std::exchange(duplicates_, {})) {
    Job& job = context_.jobs.at(band.job);
    const Reporter reporter = context_.reporter_of(band);
    if (!context_.quarantine.contains(reporter.process)) {
      comparison_.compare(job, *job.pass_of(band.band), band, reporter);
    }
  }
}

void Restart::finish() {
  barrier_.begin_after_restart();
  for (const JobId id : context_.jobs.active()) {
    comparison_.reopen_disputes(context_.jobs.at(id));
  }
  compare_duplicates();
  sequences_.resume_after_restart();
  for (auto& [id, job] : context_.jobs.all()) {
    resume(job);
  }
}

/// Continues a job after the restart, unless a user paused it. Fails a job that was begun with
/// another pixel version. Drops the bands of a final job.
void Restart::resume(Job& job) {
  if (is_final(job.state)) {
    if (job.bands_on_disk) {
      context_.act(action::DropBands{job.id});
    }
    return;
  }
  const std::uint32_t here = context_.options.compatibility.pixel_version;
  if (job.pixel_version != here) {
    lifecycle_.end(job, JobState::kFailed, other_pixel_version(job.pixel_version, here));
    return;
  }
  planner_.plan_first(job);
  bands_.note_missing_audited(job);
  job.throughput = {};
  job.clock.set(job.elapsed_noted);
  if (job.held) {
    if (job.state != JobState::kPaused) {
      context_.emit(record::StateChanged{job.id, JobState::kPaused, kPausedByUser});
    }
    return;
  }
  if (job.state != JobState::kRunning) {
    // If the job was paused because of the disk, the disk is tried again. If the job was finishing,
    // its result was not written yet.
    context_.emit(record::StateChanged{job.id, JobState::kRunning, ""});
  }
  context_.jobs.mark_leasable(job);
  lifecycle_.advance(job);
}

}  // namespace bandsaw::coordinator
