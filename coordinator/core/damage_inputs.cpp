// Bands whose pixels are damaged on disk: they are free again, and rendered again.

#include "absl/strings/str_cat.h"
#include "coordinator/core/band_text.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

/// Frees the bands that are stored still. A job whose image was asked for runs again: the film did
/// not give the image.
void Core::State::on(const input::BandsDamaged& in) {
  Job* job = find(in.job);
  if (job == nullptr || is_final(job->state)) {
    return;
  }
  for (const auto& [band, renderer] : in.bands) {
    const Pass* pass = job->pass_of(band);
    if (pass == nullptr || !pass->has_stored(band, renderer)) {
      continue;  // void since
    }
    close_audits(*job, band, renderer);
    emit(record::BandLost{job->id, band, renderer});
    job->damage = absl::StrCat(
        ++job->damaged_bands,
        " of its bands were damaged on the coordinator's disk and are rendered again; the last: ",
        name_of(band), "; check the disk");
  }
  job->image_asked = false;
  if (job->state == JobState::kFinishing) {
    emit(record::StateChanged{job->id, JobState::kRunning, ""});
  }
  touch(*job);
  settle(*job);
}

void Core::State::note_damage(JobId id, std::uint64_t bytes) {
  if (Job* job = find(id); job != nullptr && !is_final(job->state)) {
    job->damage = absl::StrCat(bytes,
                               " bytes of its bands on the coordinator's disk were damaged, or not "
                               "written to the end; their rows are rendered again");
  }
}

/// Ends the audits of what the renderer stored of a band: there is nothing left to compare with.
void Core::State::close_audits(Job& job, const Band& band, std::uint64_t renderer) {
  const auto of_it = [&](const Audit& audit) {
    return audit.stored().witness.renderer == renderer && meet(audit.band(), band);
  };
  std::vector<LeaseId> useless;
  for (const Audit& audit : job.audits) {
    if (of_it(audit) && audit.lease != 0) {
      useless.push_back(audit.lease);
    }
  }
  end_all(useless, Revoke::kYes);
  std::erase_if(job.audits, of_it);
}

/// After a restart: a band that a second machine vouched for is not in the log any more. The same
/// renderer may render it again, and must be audited again.
void Core::State::note_lost_audited(Job& job) {
  const auto audited = job.audited;
  for (const auto& [band, renderer] : audited) {
    const Pass* pass = job.pass_of(band);
    if (pass != nullptr && !quarantined_.contains(renderer) &&
        !pass->coverage.wanted(band).empty()) {
      emit(record::BandLost{job.id, band, renderer});
    }
  }
}

}  // namespace bandsaw::coordinator
