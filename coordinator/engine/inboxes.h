#pragma once

// The messages that the engine's threads send to each other. SchedulerThread, StoreThread and
// FilmThread call the inboxes of the other threads. Engine implements each inbox by posting to the
// mailbox of its thread, so a call never blocks. The messages of one sender arrive in the order in
// which they were sent. Tests implement inboxes that record the calls. Most messages are about a
// band: a range of rows and samples of a job that a worker has rendered.

#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/incoming_band.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/finished.h"

namespace bandsaw::coordinator {

/// Messages to the scheduler's thread.
class SchedulerInbox {
 public:
  virtual ~SchedulerInbox() = default;
  // Messages from the store. It calls band_stored or band_failed once for each band that it got.
  virtual void band_stored(IncomingBand incoming, std::vector<std::uint64_t> row_digests) = 0;
  virtual void band_failed(IncomingBand incoming, const absl::Status& status) = 0;
  virtual void result_written(JobId job, const absl::Status& status) = 0;
  /// The disk takes data again after StoreInbox::test_disk_until_writable.
  virtual void disk_is_back() = 0;
  /// These final jobs are to be forgotten, because a limit of engine/collector.h is exceeded.
  virtual void forget(std::vector<JobId> jobs) = 0;
  // Messages from the film.
  virtual void pass_merged(input::PassMerged merged) = 0;
  /// The film could not take a band, or make the image. It tries again after FilmInbox::retry.
  virtual void storage_failed(JobId job, const absl::Status& status) = 0;
  /// The band log no longer holds bands that were added. The film leaves them out.
  virtual void bands_damaged(input::BandsDamaged damaged) = 0;
};

/// Messages to the store's thread, which alone writes the logs of bands and the results.
/// StoreThread has the same functions and says when they fail.
class StoreInbox {
 public:
  virtual ~StoreInbox() = default;
  /// Creates the folder of a new job.
  virtual void add_job(JobId job, const JobSpec& spec) = 0;
  /// Writes a band to its job's log.
  virtual void append(IncomingBand incoming) = 0;
  /// Computes the digests of a band's rows and sends band_stored. Does not write the band, because
  /// all of its rows are stored already. The new digests are only compared with those of the stored
  /// rows.
  virtual void compare(IncomingBand incoming) = 0;
  virtual void write_result(JobId job, Finished finished) = 0;
  /// Called when the job's log was found damaged. Later bands are appended after the last sound
  /// record of the log.
  virtual void reopen(JobId job) = 0;
  /// Removes the log of a final job.
  virtual void drop_bands(JobId job) = 0;
  /// Removes all files of a forgotten job.
  virtual void drop_job(JobId job) = 0;
  /// Removes the blobs and folders that no job needs. `jobs` are all known jobs.
  virtual void collect(std::vector<KeptJob> jobs) = 0;
  /// Called after a failed write. The store sends disk_is_back once the disk takes data again.
  virtual void test_disk_until_writable() = 0;
};

/// Messages to the film's thread, which adds the bands of each job to its image. FilmThread has the
/// same functions and says when they fail.
class FilmInbox {
 public:
  virtual ~FilmInbox() = default;
  virtual void add_job(JobId job, const RenderSettings& settings, bool adaptive) = 0;
  /// Announces a pass that ends at `samples`; pass_merged follows when the film has all of it.
  virtual void plan(JobId job, std::uint64_t samples) = 0;
  /// Adds these rows of a stored band.
  virtual void add(IncomingBand incoming, std::vector<RowRange> rows) = 0;
  /// Sends the image of samples [0, samples) to the store as soon as the film has them.
  virtual void request_image(JobId job, std::uint64_t samples) = 0;
  /// Retries the additions and images that failed.
  virtual void retry() = 0;
  /// Removes the bands of this worker process, whose pixels are not trusted any more.
  virtual void retract(JobId job, std::uint64_t process) = 0;
  /// Forgets the film of a job.
  virtual void drop(JobId job) = 0;
};

}  // namespace bandsaw::coordinator
