#pragma once

// The store's thread: it writes the logs of bands and the results, removes old jobs, and tests a
// disk that has failed until the disk takes data again. All bands that have arrived for one log are
// synced to disk together (group commit).

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/clock.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/inboxes.h"
#include "coordinator/store/band_log.h"
#include "coordinator/store/blob_store.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/finished.h"
#include "coordinator/store/result_file.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class StoreThread {
 public:
  /// All references MUST outlive it.
  StoreThread(const DataFolder& folder, BlobStore& blobs, const Keep& keep, const Clock& clock,
              SchedulerInbox& scheduler)
      : folder_(folder), clock_(clock), scheduler_(scheduler), collector_(folder, blobs, keep) {}

  /// Opens the log of a job and calls `each` with every record and its offset. Records of another
  /// job are left out and counted as damaged.
  absl::StatusOr<BandLogReport> open_job(JobId job, const JobSpec& spec,
                                         absl::FunctionRef<void(BandRecord, std::uint64_t)> each);
  /// Creates the folder of a new job. If this fails, it is tried again at the job's first band.
  absl::Status add_job(JobId job, const JobSpec& spec);

  /// Writes a band to the log of its job. settle() answers the band, after the log is synced.
  void append(IncomingBand incoming);
  /// Computes the row digests of a band and sends the scheduler band_stored. Does not write the
  /// band, because its rows are stored already.
  void compare(IncomingBand incoming);
  /// MUST be called after each batch. Syncs each log that was written (one fdatasync per log), then
  /// answers its bands. Every two seconds, tests a disk that has failed.
  void settle();

  /// Writes the files of a finished job and sends the scheduler result_written, with the error if
  /// there was one.
  void write_result(JobId job, const Finished& finished);
  /// Reads a part of a result (store/finished.h). DATA_LOSS: missing or damaged. NOT_FOUND: the
  /// result has no such part.
  absl::StatusOr<StoredResult> read_result(JobId job, FinishedPart part) const;
  /// Called when the log was found damaged. Later bands are appended after the last sound record of
  /// the log, or to a new log if the log is missing.
  void reopen(JobId job);
  /// Removes the log of a final job.
  void drop_bands(JobId job);
  /// Removes all files of a forgotten job.
  void drop_job(JobId job);
  /// Removes blobs and folders that are no longer needed, and sends the scheduler the jobs that
  /// exceed a limit of engine/collector.h. `jobs`: all known jobs.
  void collect(const std::vector<KeptJob>& jobs);
  /// Called after a failed write. Tests the disk until it takes data, then sends disk_is_back.
  void test_disk_until_writable();

 private:
  struct OpenJob {
    JobSpec spec;
    std::optional<BandLog> log;         ///< opened at the first band
    std::vector<IncomingBand> written;  ///< bands that are in the log, but not synced to disk
  };
  /// Writes the band to the job's log, and sets `offset` and `written` of the band.
  absl::Status write(OpenJob& job, IncomingBand& incoming);
  /// Opens the job's log if it is not open.
  absl::Status open_log(JobId id, OpenJob& job);
  /// Syncs the job's log, which MUST be open, and answers the bands in OpenJob::written.
  void settle(OpenJob& job);

  const DataFolder& folder_;
  const Clock& clock_;
  SchedulerInbox& scheduler_;
  Collector collector_;
  std::map<JobId, OpenJob> jobs_;
  bool trouble_ = false;  ///< true from a failed write until a test finds the disk writable
  Time tested_at_ = 0;    ///< when the disk was last tested
};

}  // namespace bandsaw::coordinator
