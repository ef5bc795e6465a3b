#pragma once

// The film's thread. A film holds the sums of all pixels of a job's image. Each job that is not
// final has a film. The thread adds bands (ranges of rows and samples, rendered by workers) to the
// film, reports passes as they become complete, and makes the image at the end. A pass is a range
// of samples of the whole image.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/attribution.h"
#include "coordinator/engine/inboxes.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/finished.h"
#include "renderlib/image/image.h"
#include "renderlib/render/film.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class FilmThread {
 public:
  /// All references MUST outlive it.
  FilmThread(const DataFolder& folder, SchedulerInbox& scheduler, StoreInbox& store)
      : folder_(folder), scheduler_(scheduler), store_(store) {}

  /// Announces a job. `adaptive`: the film also measures the error of each half tile (half of the
  /// pixels of a square of 16 x 16).
  void add_job(JobId job, const RenderSettings& settings, bool adaptive = false);
  /// Announces a pass that ends at `samples`. The pass is reported when the film contains all of
  /// it.
  void plan(JobId job, std::uint64_t samples);
  /// Adds these rows of a band. OK: they are in the film. Otherwise they wait in memory for retry,
  /// and SchedulerInbox::storage_failed is called.
  absl::Status add(JobId job, IncomingBand incoming, std::vector<RowRange> rows);
  /// Remembers these rows of a band. The next retry reads the band from the job's log and adds the
  /// rows. This function is for bands that are in the log while the film cannot take any band.
  void add_later(JobId job, const IncomingBand& incoming, const std::vector<RowRange>& rows);
  /// Sends the image of samples [0, samples) to the store as soon as the film has them.
  void request_image(JobId job, std::uint64_t samples);
  /// Retries the additions and images that failed.
  void retry();
  /// Removes the bands of this worker process: builds the film again from the other bands in the
  /// job's log, and reports passes again as they become complete.
  void retract(JobId job, std::uint64_t process);
  /// Forgets the film of a job.
  void drop(JobId job);

  /// Returns the present image of a job, every row_step-th row. NOT_FOUND: no band is there, or the
  /// job is over.
  absl::StatusOr<Image> preview(JobId job, std::uint32_t row_step) const;
  /// Returns which worker rendered which rows; for a job that is over, from the file beside its
  /// image.
  std::vector<RowsBy> rendered_by(JobId job) const;

 private:
  struct Waiting {
    IncomingBand incoming;
    std::vector<RowRange> rows;
  };
  /// Rows that were added, with what is needed to read them again from the job's log.
  struct Added {
    std::uint64_t offset = 0;  ///< offset of the record that holds the band
    Band band;
    std::uint64_t process = 0;
    TileSamples tiles;         ///< how many samples each half tile of these rows takes
    std::uint64_t digest = 0;  ///< digest of the rows' sums
  };
  struct OneJob {
    RenderSettings settings;
    bool adaptive = false;
    std::optional<Film> film;     ///< std::nullopt: no band was added yet, or `rebuild` is true
    std::deque<Waiting> waiting;  ///< bands that are not in the film yet
    std::vector<Added> added;     ///< all rows in the film
    std::set<std::uint64_t> pass_ends;      ///< numbers of samples at which planned passes end
    std::uint64_t reported = 0;             ///< end of the last pass that was reported
    bool rebuild = false;                   ///< the film must be built again, from `added`
    std::optional<std::uint64_t> image_of;  ///< the image of this many samples is requested
  };
  /// Returns the entry of OneJob::added for these rows of a band.
  static Added added(const IncomingBand& incoming, const RowRange& rows);
  /// Brings the job's film up to date: builds it again if that is needed, adds the bands that wait,
  /// reports complete passes, and sends the image if it was requested. If a step fails, informs the
  /// scheduler and returns the error.
  absl::Status work(JobId id, OneJob& job);
  /// Builds the film from all rows in OneJob::added, and reports the complete passes.
  absl::Status rebuild_film(JobId id, OneJob& job);
  /// Adds the rows of `waiting` to the film, and removes them from `waiting`.
  absl::Status merge(JobId id, OneJob& job, Waiting& waiting);
  /// Reports each planned pass that is complete and was not reported.
  void report_passes(JobId id, OneJob& job);
  /// Sends the image to the store if it was requested and the film has all of its samples.
  absl::Status send_image(JobId id, OneJob& job);
  absl::StatusOr<Film> new_film(JobId id, const OneJob& job) const;
  absl::StatusOr<Film> film_until(JobId id, OneJob& job, std::uint64_t samples);
  absl::StatusOr<BandPixels> read_again(JobId id, const Added& added) const;
  void leave_out(JobId id, OneJob& job, const std::vector<std::size_t>& damaged);

  const DataFolder& folder_;
  SchedulerInbox& scheduler_;
  StoreInbox& store_;
  std::map<JobId, OneJob> jobs_;
  Attribution attribution_;
};

/// Returns the part of a band that consists of these rows.
BandPixels slice(const BandPixels& pixels, const RowRange& rows);

}  // namespace bandsaw::coordinator
