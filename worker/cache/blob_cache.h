#pragma once

// Blobs on the worker's disk: `<folder>/<digest in hexadecimal>`, whole or not at all, the least
// recently used thrown away when there are too many bytes. Several workers of one machine may share
// a folder: names are digests, files appear by rename, a download holds a lock on its partial file,
// and a file that vanishes under a reader only means fetching it again.

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/base/mutex.h"
#include "renderlib/package/blob_folder.h"

namespace bandsaw::worker {

class BlobCache : public BlobSource {
 public:
  /// Makes the folder. Any error names it.
  static absl::StatusOr<std::unique_ptr<BlobCache>> open(std::string folder,
                                                         std::uint64_t max_bytes);

  bool has(const wire::Digest& digest) const;
  /// Checks the digest each time; a damaged file is removed before DATA_LOSS is returned. Counts as
  /// a use.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

  /// A blob on its way here. What was written stays when it is dropped, and the next download goes
  /// on from there.
  class Download {
   public:
    Download(BlobCache& cache, const wire::Digest& digest, int fd, std::uint64_t offset);
    ~Download();
    Download(const Download&) = delete;
    Download& operator=(const Download&) = delete;

    std::uint64_t offset() const { return offset_; }  ///< of the next byte wanted
    /// RESOURCE_EXHAUSTED: the disk is full.
    absl::Status append(absl::Span<const std::byte> bytes);
    /// DATA_LOSS: the bytes do not have the digest; they are thrown away.
    absl::Status commit();

   private:
    BlobCache& cache_;
    const wire::Digest digest_;
    const int fd_;
    std::uint64_t offset_;
  };
  /// Nothing: another worker of this machine is fetching it now; look again a little later.
  absl::StatusOr<std::unique_ptr<Download>> begin(const wire::Digest& digest);

 private:
  BlobCache(std::string folder, std::uint64_t max_bytes);
  std::string part_of(const wire::Digest& digest) const;
  /// Throws away until the rest fits; keeps `newest`.
  void make_room(std::uint64_t added, const std::string& newest) EXCLUDES(mutex_);
  /// Throws away what was used longest ago, where the disk is full: `wanted` bytes, or more. False:
  /// there is nothing left to throw away.
  bool give_up_some(std::uint64_t wanted) EXCLUDES(mutex_);

  const std::string folder_;
  const std::uint64_t max_bytes_;
  BlobFolder blobs_;
  Mutex mutex_;
  std::uint64_t bytes_ GUARDED_BY(mutex_) =
      0;  ///< when last counted, plus what was added since by this worker
};

}  // namespace bandsaw::worker
