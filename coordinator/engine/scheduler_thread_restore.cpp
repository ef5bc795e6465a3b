// restore() replays the journal. For each job that is not final, it then replays the band log,
// which is the file with the bands that workers have rendered. Each band goes to the scheduler. The
// rows of the band that are still wanted go to the film of the job.

#include <spdlog/spdlog.h>

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/film_thread.h"
#include "coordinator/engine/scheduler_thread.h"
#include "coordinator/engine/store_thread.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::Status SchedulerThread::restore(StoreThread& store, FilmThread& film,
                                      const absl::Status& disk) {
  RETURN_IF_ERROR(journal_.replay([this](const Record& record) {
    scheduler_.replay(record);
    note(record);
  }));
  std::vector<std::pair<JobId, absl::Status>> failed;
  for (const auto& [id, known] : known_) {
    if (is_final(known.state)) {
      store.drop_bands(id);
    } else if (const absl::Status restored = restore_job(id, known, store, film);
               absl::IsResourceExhausted(restored)) {
      failed.emplace_back(id, restored);
    } else {
      RETURN_IF_ERROR(restored);
    }
  }
  absorb(scheduler_.replayed(clock_.now()), /*incoming=*/nullptr);
  if (!disk.ok()) {
    disk_is_full(disk);
  }
  for (const auto& [id, status] : failed) {
    store_.test_disk_until_writable();
    storage_failed(id, status);
  }
  return absl::OkStatus();
}

/// Restores a job and, from the band log of the job, its film (the sums of all pixels).
/// RESOURCE_EXHAUSTED: the disk is full. Then the job is restored without its film. The film is
/// restored when the disk has space again.
absl::Status SchedulerThread::restore_job(JobId id, const Known& known, StoreThread& store,
                                          FilmThread& film) {
  film.add_job(id, known.spec.settings, is_adaptive(known.spec.stop));
  for (const std::uint64_t samples : known.pass_ends) {
    film.plan(id, samples);
  }
  absl::Status filmed;  // the first error of the film
  const auto take = [&](BandRecord record, std::uint64_t offset) {
    BandPixels& pixels = record.pixels;
    std::optional<std::vector<RowRange>> rows = scheduler_.wanted(id, pixels.band);
    if (!rows) {
      return;
    }
    const Band band = pixels.band;
    scheduler_.replay(input::BandStored{.job = id,
                                        .band = pixels.band,
                                        .row_digests = row_digests(pixels),
                                        .instance = {},
                                        .process = record.process,
                                        .counters = pixels.counters,
                                        .cpu_s = record.cpu_s});
    if (rows->empty()) {
      return;  // a duplicate: the scheduler compares it, and the film has its rows already
    }
    // If the rows are still wanted after the replay, the scheduler did not count the band, because
    // the machine that rendered it is in quarantine. Then the film does not get the band either.
    if (const auto left = scheduler_.wanted(id, band); left && left->empty()) {
      IncomingBand incoming;
      incoming.process = record.process;
      incoming.pixels = std::move(pixels);
      incoming.offset = offset;
      incoming.tiles = scheduler_.tiles(id, band);
      if (filmed.ok()) {
        filmed = film.add(id, std::move(incoming), *std::move(rows));
      } else {
        film.add_later(id, incoming, *rows);
      }
    }
  };
  ASSIGN_OR_RETURN(const BandLogReport report, store.open_job(id, known.spec, take));
  if (report.damaged_bytes > 0) {
    scheduler_.replay_damage(id, report.damaged_bytes);
    spdlog::warn(
        "job={} {} damaged bytes in its bands were left out; their rows are rendered again", id,
        report.damaged_bytes);
  }
  spdlog::info("job={} resumed, {} bands on disk", id, report.records);
  return filmed.ok() ? filmed
                     : absl::Status(filmed.code(), absl::StrCat("cannot rebuild the film of job ",
                                                                id, ": ", filmed.message()));
}

}  // namespace bandsaw::coordinator
