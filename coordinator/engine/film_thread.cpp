// A film holds the sums of all pixels of a job's image. For each job, work() brings the film up to
// date: it builds the film again if that is needed, adds the bands that wait, reports complete
// passes (ranges of samples of the whole image), and sends the image if it was requested. If one of
// these steps fails, the remaining steps wait for retry().

#include "coordinator/engine/film_thread.h"

#include <algorithm>
#include <span>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/store/band_log.h"
#include "renderlib/base/check.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/hash64.h"

namespace bandsaw::coordinator {
namespace {

/// Returns true if reading the band again cannot succeed. UNKNOWN is the code of an unreadable
/// sector (EIO).
bool is_damage(const absl::Status& status) {
  return absl::IsDataLoss(status) || absl::IsOutOfRange(status) || absl::IsNotFound(status) ||
         absl::IsUnknown(status);
}

/// Returns a digest of the sums of these rows of a band.
std::uint64_t digest_of(const BandPixels& pixels, const RowRange& rows) {
  const std::vector<std::uint64_t> digests = row_digests(pixels);
  const std::span<const std::uint64_t> all = digests;
  Hash64 hash;
  hash.add(std::as_bytes(all.subspan(rows.first - pixels.band.rows.first, rows.count())));
  return hash.value();
}

}  // namespace

void FilmThread::add_job(JobId job, const RenderSettings& settings, bool adaptive) {
  jobs_[job].settings = settings;
  jobs_[job].adaptive = adaptive;
}

void FilmThread::plan(JobId id, std::uint64_t samples) {
  if (const auto job = jobs_.find(id); job != jobs_.end()) {
    job->second.pass_ends.insert(samples);
  }
}

absl::Status FilmThread::add(JobId id, IncomingBand incoming, std::vector<RowRange> rows) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end() || rows.empty()) {
    return absl::OkStatus();
  }
  job->second.waiting.push_back({std::move(incoming), std::move(rows)});
  return work(id, job->second);
}

void FilmThread::add_later(JobId id, const IncomingBand& incoming,
                           const std::vector<RowRange>& rows) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) {
    return;
  }
  for (const RowRange& range : rows) {
    job->second.added.push_back(added(incoming, range));
  }
  job->second.film.reset();
  job->second.rebuild = true;
}

void FilmThread::request_image(JobId id, std::uint64_t samples) {
  if (const auto job = jobs_.find(id); job != jobs_.end()) {
    job->second.image_of = samples;
    work(id, job->second).IgnoreError();  // `work` informs the scheduler
  }
}

void FilmThread::retry() {
  for (auto& [id, job] : jobs_) {
    make_folder(folder_.job(id)).IgnoreError();  // if the folder is missing, `work` reports it
    if (job.rebuild || !job.waiting.empty() || job.image_of) {
      work(id, job).IgnoreError();  // `work` informs the scheduler
    }
  }
}

void FilmThread::retract(JobId id, std::uint64_t process) {
  const auto job = jobs_.find(id);
  if (job == jobs_.end()) {
    return;
  }
  const auto by = [&](const auto& one) { return one.process == process; };
  std::erase_if(job->second.waiting, [&](const Waiting& waiting) { return by(waiting.incoming); });
  std::erase_if(job->second.added, by);
  job->second.rebuild = true;
  job->second.reported = 0;
  work(id, job->second).IgnoreError();  // `work` informs the scheduler
}

void FilmThread::drop(JobId job) {
  jobs_.erase(job);
  attribution_.forget(job);
}

std::vector<RowsBy> FilmThread::rendered_by(JobId job) const {
  if (jobs_.contains(job)) {
    return attribution_.of(job);
  }
  auto stored = read_attribution(folder_.attribution(job));
  if (absl::IsNotFound(stored.status())) {
    stored = read_attribution(folder_.old_attribution(job));
  }
  return std::move(stored).value_or(std::vector<RowsBy>());
}

absl::StatusOr<Image> FilmThread::preview(JobId id, std::uint32_t row_step) const {
  const auto job = jobs_.find(id);
  if (job == jobs_.end() || !job->second.film) {
    return absl::NotFoundError(absl::StrCat("there is no picture of job ", id, " yet"));
  }
  return job->second.film->snapshot(row_step).image;
}

absl::Status FilmThread::work(JobId id, OneJob& job) {
  absl::Status status = job.rebuild ? rebuild_film(id, job) : absl::OkStatus();
  while (status.ok() && !job.waiting.empty()) {
    status = merge(id, job, job.waiting.front());
    if (status.ok()) {
      job.waiting.pop_front();
      report_passes(id, job);
    }
  }
  if (status.ok()) {
    status = send_image(id, job);
  }
  if (!status.ok()) {
    // The scheduler is informed first, so that it pauses the job before the store can report that
    // the disk is back.
    scheduler_.storage_failed(id, status);
    store_.test_disk_until_writable();
  }
  return status;
}

absl::Status FilmThread::rebuild_film(JobId id, OneJob& job) {
  job.film.reset();  // frees its disk space for the new film
  ASSIGN_OR_RETURN(job.film, film_until(id, job, kMaxSamples));
  job.rebuild = false;
  report_passes(id, job);
  return absl::OkStatus();
}

absl::Status FilmThread::merge(JobId id, OneJob& job, Waiting& waiting) {
  if (!job.film) {
    ASSIGN_OR_RETURN(job.film, new_film(id, job));
  }
  const BandPixels& pixels = waiting.incoming.pixels;
  while (!waiting.rows.empty()) {
    const RowRange rows = waiting.rows.back();
    RETURN_IF_ERROR(job.film->add(rows == pixels.band.rows ? pixels : slice(pixels, rows),
                                  waiting.incoming.tiles.of(rows)));
    attribution_.add(id, rows, waiting.incoming.process, waiting.incoming.worker);
    job.added.push_back(added(waiting.incoming, rows));
    waiting.rows.pop_back();
  }
  return absl::OkStatus();
}

void FilmThread::report_passes(JobId id, OneJob& job) {
  for (auto end = job.pass_ends.upper_bound(job.reported);
       end != job.pass_ends.end() && job.film->complete(*end); ++end) {
    job.reported = *end;
    scheduler_.pass_merged(
        {.job = id,
         .samples = job.reported,
         .error = job.film->error(),
         .tiles = job.adaptive ? job.film->tile_errors() : std::vector<HalfTileErrors>()});
  }
}

absl::Status FilmThread::send_image(JobId id, OneJob& job) {
  if (!job.image_of || !job.film || !job.film->complete(*job.image_of)) {
    return absl::OkStatus();
  }
  const std::uint64_t samples = *job.image_of;
  const auto is_beyond = [&](const Added& one) { return one.band.samples.last > samples; };
  if (std::any_of(job.added.begin(), job.added.end(), is_beyond)) {
    ASSIGN_OR_RETURN(job.film, film_until(id, job, samples));
    std::erase_if(job.added, is_beyond);
    if (!job.film->complete(samples)) {
      job.image_of.reset();  // the scheduler requests it again after the damaged bands are replaced
      return absl::OkStatus();
    }
  }
  job.image_of.reset();
  // Earlier reports may be about more samples than the image has. So the error of the image itself
  // is reported.
  scheduler_.pass_merged({.job = id, .samples = samples, .error = job.film->error()});
  Finished finished{job.film->snapshot().image, /*first=*/std::nullopt, /*samples=*/std::nullopt,
                    attribution_.of(id)};
  if (computes_radiance(job.settings.integrator)) {
    if (std::optional<Film::FirstPart> first = job.film->first_part()) {
      finished.first = std::move(first->mean);
    }
  }
  if (job.adaptive) {
    finished.samples = job.film->counts();
  }
  store_.write_result(id, std::move(finished));
  return absl::OkStatus();
}

absl::StatusOr<Film> FilmThread::new_film(JobId id, const OneJob& job) const {
  return Film::create(job.settings.width, job.settings.height, folder_.job(id),
                      job.adaptive ? Film::Grain::kHalfTiles : Film::Grain::kRows);
}

FilmThread::Added FilmThread::added(const IncomingBand& incoming, const RowRange& rows) {
  return {.offset = incoming.offset,
          .band = {incoming.pixels.band.samples, rows},
          .process = incoming.process,
          .tiles = incoming.tiles.of(rows),
          .digest = digest_of(incoming.pixels, rows)};
}

/// Builds a film of the bands whose samples end at or before `samples`. The bands are read from the
/// log. A band cannot be removed from an existing film, because the film adds neighbouring ranges
/// of samples and keeps only their common sum. Bands that the log no longer holds are left out and
/// reported. Fails if the film cannot be created, or the log cannot be read for a reason other than
/// damage.
absl::StatusOr<Film> FilmThread::film_until(JobId id, OneJob& job, std::uint64_t samples) {
  ASSIGN_OR_RETURN(Film film, new_film(id, job));
  std::vector<std::size_t> damaged;
  for (std::size_t i = 0; i < job.added.size(); ++i) {
    const Added& one = job.added[i];
    if (one.band.samples.last > samples) {
      continue;
    }
    const absl::StatusOr<BandPixels> pixels = read_again(id, one);
    if (is_damage(pixels.status())) {
      damaged.push_back(i);
      continue;
    }
    RETURN_IF_ERROR(pixels.status());
    RETURN_IF_ERROR(film.add(*pixels, one.tiles));
  }
  leave_out(id, job, damaged);
  return film;
}

/// Reads rows from the log, bit for bit as they were added. DATA_LOSS: the record at the offset
/// belongs to another band, or its sums are different.
absl::StatusOr<BandPixels> FilmThread::read_again(JobId id, const Added& added) const {
  ASSIGN_OR_RETURN(const BandRecord record, read_band(folder_.bands(id), added.offset));
  const Band& found = record.pixels.band;
  const RowRange& rows = added.band.rows;
  if (found.samples != added.band.samples || rows.first < found.rows.first ||
      found.rows.last < rows.last || digest_of(record.pixels, rows) != added.digest) {
    return absl::DataLossError(
        absl::StrCat(folder_.bands(id), " holds another band at byte ", added.offset));
  }
  return slice(record.pixels, rows);
}

/// Forgets rows that the log no longer holds, and reports them to the store and the scheduler.
/// `damaged`: ascending indices in job.added.
void FilmThread::leave_out(JobId id, OneJob& job, const std::vector<std::size_t>& damaged) {
  std::vector<input::BandsDamaged::DamagedBand> lost;
  for (auto index = damaged.rbegin(); index != damaged.rend(); ++index) {
    const auto one = job.added.begin() + static_cast<std::ptrdiff_t>(*index);
    lost.push_back({one->band, one->process});
    job.added.erase(one);
  }
  if (!lost.empty()) {
    // The store must accept bands of the job again before the scheduler leases the first lost band.
    store_.reopen(id);
    scheduler_.bands_damaged({.job = id, .bands = std::move(lost)});
  }
}

BandPixels slice(const BandPixels& pixels, const RowRange& rows) {
  const RowRange& all = pixels.band.rows;
  BANDSAW_CHECK(all.first <= rows.first && rows.last <= all.last, "the band has these rows");
  const std::size_t row = std::size_t{pixels.width} * 3;
  const auto first =
      pixels.sums.begin() + static_cast<std::ptrdiff_t>((rows.first - all.first) * row);
  return {.band = {.samples = pixels.band.samples, .rows = rows},
          .width = pixels.width,
          .sums = {first, first + static_cast<std::ptrdiff_t>(rows.count() * row)},
          .counters = {}};
}

}  // namespace bandsaw::coordinator
