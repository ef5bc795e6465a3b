#pragma once

// Finds old final jobs (done, failed or cancelled), and removes the blobs (the data of scenes) that
// no job needs. All data of a job that is not final is kept.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"
#include "coordinator/store/blob_store.h"
#include "coordinator/store/data_folder.h"

namespace bandsaw::coordinator {

/// Limits on the age, size and number of the jobs that are over. Jobs beyond a limit are removed.
struct Keep {
  double seconds = 30.0 * 24 * 60 * 60;  ///< maximum age of a final job
  /// Maximum size of the files of final jobs and of blobs in total; the oldest jobs are removed
  /// first.
  std::uint64_t bytes = 100'000'000'000;
  double min_seconds = 60.0 * 60;  ///< minimum age at which `bytes` removes a final job
  std::size_t jobs = 10'000;  ///< maximum number of final jobs; each takes about 4 kB of memory
  /// Maximum age of a blob, or of a part of a blob, that no job needs. The age is counted from the
  /// time at which the blob was last sent or requested.
  double unused_seconds = 24.0 * 60 * 60;
};

/// Not thread-safe; only the store's thread uses it.
class Collector {
 public:
  Collector(const DataFolder& folder, BlobStore& blobs, const Keep& keep)
      : folder_(folder), blobs_(blobs), keep_(keep) {}

  /// Returns the final jobs that are to be forgotten, oldest first. `now`: seconds since 1970.
  std::vector<JobId> to_forget(const std::vector<KeptJob>& jobs, double now);

  /// Removes blobs that none of the jobs needs, and folders of unknown jobs.
  void sweep(const std::vector<KeptJob>& jobs, double now);

 private:
  struct Final {
    JobId id = 0;
    double at = 0;            ///< time at which the job ended, seconds since 1970
    std::uint64_t bytes = 0;  ///< size of its files
  };
  /// The blobs of the packages of one job, each once. A package is the data of a scene: a manifest
  /// and the blobs that the manifest names.
  struct Needs {
    std::size_t packages = 0;  ///< number of packages that were read
    std::set<wire::Digest> blobs;
  };
  Final final_job(const KeptJob& job, double now) const;
  void add_files_of(JobId id, Final& job) const;
  /// Adds the blobs of a package, its manifest included. Adds none if the manifest is missing or
  /// damaged. Returns false if the manifest cannot be read for another reason.
  bool add_blobs_of(const DigestHex& manifest, Needs& needs);
  /// Returns the blobs of a job's packages; std::nullopt: add_blobs_of() has returned false for one
  /// of the packages.
  std::optional<std::set<wire::Digest>> blobs_of(const KeptJob& job);
  /// Returns the result of blobs_of(), or an empty set instead of std::nullopt.
  std::set<wire::Digest> known_blobs_of(const KeptJob& job);
  /// Removes the blobs that are not in `needed` and were not used for Keep::unused_seconds.
  void remove_unneeded(const std::set<wire::Digest>& needed, double now);

  const DataFolder& folder_;
  BlobStore& blobs_;
  const Keep keep_;
  /// Cache of blobs_of. A package never changes, but a sequence may get more packages.
  std::map<JobId, Needs> known_;
};

}  // namespace bandsaw::coordinator
