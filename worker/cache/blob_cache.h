#pragma once

// The worker's disk cache for blobs (arrays and manifests of scenes, named by their SHA-256). The
// name of a file is `<folder>/<digest in hexadecimal>`. Files are written atomically. When the size
// limit is exceeded, the least recently used files are removed. Several workers of one machine may
// share a folder, because files appear by rename, a download holds a lock on its partial file, and
// a file that is removed during a read only has to be fetched again.

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
  /// Opens the cache in `folder`, which may take `max_bytes`. Creates the folder if necessary. If
  /// the folder cannot be created or used, the error names the folder.
  static absl::StatusOr<std::unique_ptr<BlobCache>> open(std::string folder,
                                                         std::uint64_t max_bytes);

  bool has(const wire::Digest& digest) const;
  /// Returns the blob and marks it as used. NOT_FOUND: the cache does not have it. DATA_LOSS: the
  /// file was damaged (the digest is checked at each call) or could not be read; it is now removed.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

  /// A download in progress. When this object is destroyed, the bytes written so far are kept, and
  /// the next download of the blob resumes after them.
  class Download {
   public:
    Download(BlobCache& cache, const wire::Digest& digest, int fd, std::uint64_t offset);
    ~Download();
    Download(const Download&) = delete;
    Download& operator=(const Download&) = delete;

    std::uint64_t offset() const { return offset_; }  ///< offset of the next byte to fetch
    /// Appends the next bytes. RESOURCE_EXHAUSTED: the disk or the user's quota is full, and
    /// nothing is left to evict.
    absl::Status append(absl::Span<const std::byte> bytes);
    /// Publishes the blob under its name. DATA_LOSS: the bytes do not match the digest, or
    /// cannot be read again; they are deleted. UNAVAILABLE: the partial file cannot be renamed,
    /// e.g. because a user has removed it.
    absl::Status commit();
    /// Deletes the partial file, so that the next download begins at byte 0. This download MUST NOT
    /// continue.
    void discard();

   private:
    BlobCache& cache_;
    const wire::Digest digest_;
    const int fd_;
    std::uint64_t offset_;
  };
  /// Starts or resumes a download. Returns nullptr if another worker of this machine is fetching
  /// the blob; check again a little later. RESOURCE_EXHAUSTED: the disk or the user's quota has no
  /// inode or no space for a new partial file, and nothing is left to evict.
  absl::StatusOr<std::unique_ptr<Download>> begin(const wire::Digest& digest);

 private:
  BlobCache(std::string folder, std::uint64_t max_bytes);
  /// Returns the path of the partial file of a blob.
  std::string part_path(const wire::Digest& digest) const;
  /// Opens the partial file `path` for reading and writing, and returns its descriptor. Creates the
  /// file and the cache's folder if they are missing. Errors are those of begin().
  absl::StatusOr<int> open_part(const std::string& path) EXCLUDES(mutex_);
  /// Notes that the cache has grown by `added` bytes. If it is above its size limit, evicts the
  /// least recently used files, except the file `newest`, until the limit is kept.
  void make_room(std::uint64_t added, const std::string& newest) EXCLUDES(mutex_);
  /// Evicts the least recently used files because the disk is full, until at least `wanted` bytes
  /// are removed or no file is left. Returns false if there was nothing to evict.
  bool free_space(std::uint64_t wanted) EXCLUDES(mutex_);

  const std::string folder_;
  const std::uint64_t max_bytes_;
  BlobFolder blobs_;
  Mutex mutex_;
  /// Size of the folder at its last scan, plus the bytes that this worker has added since then.
  std::uint64_t bytes_ GUARDED_BY(mutex_) = 0;
  std::uint64_t added_ GUARDED_BY(mutex_) = 0;  ///< bytes that this worker added since that scan
};

}  // namespace bandsaw::worker
