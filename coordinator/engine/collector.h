#pragma once

// Old jobs and blobs that nobody needs: which, and their removal. All that belongs to a job that is
// not final stays.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/store/blob_store.h"
#include "coordinator/store/data_folder.h"

namespace bandsaw::coordinator {

/// How long and how much of what is over is kept.
struct Keep {
  double seconds = 30.0 * 24 * 60 * 60;   ///< a final job, since it became final
  std::uint64_t bytes = 100'000'000'000;  ///< results and blobs in all; oldest jobs go first
  double least_seconds = 60.0 * 60;       ///< a final job, whatever the bytes
  std::size_t jobs = 10'000;              ///< final jobs; each takes some 4 kB of memory
  double unused_seconds =
      24.0 * 60 * 60;  ///< a blob of no job, since it was sent or asked for; a part of one
};

/// Used by the store's thread.
class Collector {
 public:
  struct Job {
    JobId id = 0;
    DigestHex manifest;
    bool final = false;
  };

  Collector(const DataFolder& folder, BlobStore& blobs, const Keep& keep)
      : folder_(folder), blobs_(blobs), keep_(keep) {}

  /// Final jobs that are to be forgotten, oldest first. `now`: seconds since 1970.
  std::vector<JobId> to_forget(const std::vector<Job>& jobs, double now);

  /// Removes blobs that none of the jobs needs, and folders of jobs that are not known (any more).
  void sweep(const std::vector<Job>& jobs, double now);

 private:
  struct Final {
    JobId id = 0;
    double at = 0;  ///< seconds since 1970; 0: nothing of it is left
    std::uint64_t bytes = 0;
  };
  Final final_job(JobId id) const;
  /// The blobs of a package, its manifest among them; none when that is gone, nothing when it is
  /// there and cannot be read.
  std::optional<std::set<wire::Digest>> blobs_of(const DigestHex& manifest);
  std::set<wire::Digest> known_blobs_of(const DigestHex& manifest);
  void remove_unneeded(const std::set<wire::Digest>& needed, double now);

  const DataFolder& folder_;
  BlobStore& blobs_;
  const Keep keep_;
  std::map<DigestHex, std::set<wire::Digest>> known_;  ///< a package never changes
};

}  // namespace bandsaw::coordinator
