#pragma once

// What the store thread does: band logs with group commit, results, and asking a full disk whether
// it takes data again.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/clock.h"
#include "coordinator/engine/incoming_band.h"
#include "coordinator/store/band_log.h"
#include "coordinator/store/attribution_file.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/finished.h"
#include "coordinator/store/result_file.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class StoreThread {
 public:
  /// Called on the store's thread. Every band that was given ends in `stored` or `failed`.
  struct Hooks {
    std::function<void(IncomingBand, std::vector<std::uint64_t> row_digests)> stored;
    std::function<void(IncomingBand, absl::Status)> failed;
    std::function<void(JobId, absl::Status)> result_written;
    std::function<void()> disk_is_back;
  };
  StoreThread(const DataFolder& folder, const Clock& clock, Hooks hooks)
      : folder_(folder), clock_(clock), hooks_(std::move(hooks)) {}

  /// Opens the log of a job and hands on what it holds, with the byte each begins at. Records of
  /// something else are left out, and counted as damaged.
  absl::StatusOr<BandLogReport> open_job(JobId job, const JobSpec& spec,
                                         absl::FunctionRef<void(BandRecord, std::uint64_t)> each);
  /// Makes the folder of a new job.
  absl::Status add_job(JobId job, const JobSpec& spec);

  /// Written, but not answered before settle.
  void append(IncomingBand incoming);
  /// Digests of a band that is there already; not written.
  void compare(IncomingBand incoming);
  /// After each batch: one fdatasync a log, then the hooks. Asks the disk now and then while it
  /// fails.
  void settle();

  void write_result(JobId job, const Finished& finished);
  /// DATA_LOSS. NOT_FOUND: the job was not adaptive, and kSamples is asked for.
  absl::StatusOr<StoredResult> read_result(JobId job, FinishedPart part) const;
  /// The log was found damaged: what is appended from now on goes to the end of what is sound of
  /// it, or into a new one where it is missing.
  void reopen(JobId job);
  /// Removes the log of a final job.
  void drop_bands(JobId job);
  /// Removes all that is left of a forgotten job.
  void drop_job(JobId job);
  /// Something failed: `disk_is_back` comes once the disk takes data.
  void expect_trouble();

 private:
  struct OpenJob {
    JobSpec spec;
    std::optional<BandLog> log;    ///< opened at the first band
    std::vector<IncomingBand> written;  ///< not synced yet
  };
  absl::Status write(OpenJob& job, IncomingBand& incoming);
  absl::Status open_log(JobId id, OpenJob& job);
  void settle(OpenJob& job);

  const DataFolder& folder_;
  const Clock& clock_;
  Hooks hooks_;
  std::map<JobId, OpenJob> jobs_;
  bool trouble_ = false;
  Time asked_at_ = 0;
};

}  // namespace bandsaw::coordinator
