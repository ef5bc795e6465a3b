#pragma once

// What the film thread does: a film a job, its passes as they become whole, and the image at the
// end.

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/credits.h"
#include "coordinator/engine/put_band.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/finished.h"
#include "renderlib/image/image.h"
#include "renderlib/render/film.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class FilmDesk {
 public:
  /// Called on the film's thread.
  struct Hooks {
    std::function<void(input::PassMerged)> merged;
    std::function<void(JobId, Finished)> image;
    /// The film could not take a band: it is kept in memory until retry.
    std::function<void(JobId, absl::Status)> failed;
    /// The log does not hold what was added any more: it is left out of the film from now on.
    std::function<void(JobId, std::vector<input::BandsDamaged::DamagedBand>)> damaged;
  };
  FilmDesk(const DataFolder& folder, Hooks hooks) : folder_(folder), hooks_(std::move(hooks)) {}

  void add_job(JobId job, const RenderSettings& settings, bool adaptive = false);
  /// A pass that ends at `samples` was begun: it is told when it is whole.
  void plan(JobId job, std::uint64_t samples);
  /// These rows of the band are new. OK: they are in the film; otherwise they wait for retry, which
  /// `failed` says too.
  absl::Status add(JobId job, PutBand put, std::vector<RowRange> rows);
  /// The same of a band that is in the job's log, while the film cannot take any: it is read again
  /// at the next retry.
  void add_later(JobId job, const PutBand& put, const std::vector<RowRange>& rows);
  /// The image of samples [0, samples) goes to the hook as soon as the film has them.
  void want_image(JobId job, std::uint64_t samples);
  void retry();
  /// What this renderer gave is left out: the film is made anew from the log of the others, and its
  /// passes are told again as they become whole.
  void retract(JobId job, std::uint64_t renderer);
  void drop(JobId job);

  /// What is there of a job's image, of every row_step-th row. NOT_FOUND: no band is, or the job is
  /// over.
  absl::StatusOr<Image> preview(JobId job, std::uint32_t row_step) const;
  /// Who rendered the rows, as far as they are there; of jobs that are over from what lies beside
  /// the image.
  std::vector<RowsBy> rendered_by(JobId job) const;

 private:
  struct Waiting {
    PutBand put;
    std::vector<RowRange> rows;
  };
  /// What was added: enough to add it again from the job's log.
  struct Added {
    std::uint64_t offset = 0;  ///< of the record that holds the band
    Band band;
    std::uint64_t renderer = 0;
    TileSamples tiles;         ///< of these rows
    std::uint64_t digest = 0;  ///< of the rows' sums
  };
  struct OneJob {
    RenderSettings settings;
    bool adaptive = false;
    std::optional<Film> film;  ///< from the first band on
    std::deque<Waiting> waiting;
    std::vector<Added> added;
    std::set<std::uint64_t> pass_ends;
    std::uint64_t told = 0;  ///< the end of the last pass that was told
    bool anew = false;       ///< the film has what is not in `added`
    std::optional<std::uint64_t> image_of;
  };
  static Added added(const PutBand& put, const RowRange& rows);
  absl::Status work(JobId id, OneJob& job);
  absl::Status make_anew(JobId id, OneJob& job);
  absl::Status merge(JobId id, OneJob& job, Waiting& waiting);
  void tell_passes(JobId id, OneJob& job);
  absl::Status give_image(JobId id, OneJob& job);
  absl::StatusOr<Film> new_film(JobId id, const OneJob& job) const;
  absl::StatusOr<Film> film_until(JobId id, OneJob& job, std::uint64_t samples);
  absl::StatusOr<BandPixels> read_again(JobId id, const Added& added) const;
  void leave_out(JobId id, OneJob& job, const std::vector<std::size_t>& damaged);

  const DataFolder& folder_;
  Hooks hooks_;
  std::map<JobId, OneJob> jobs_;
  Credits credits_;
};

/// The part of a band that these rows are.
BandPixels slice(const BandPixels& pixels, const RowRange& rows);

}  // namespace bandsaw::coordinator
