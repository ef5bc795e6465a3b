#pragma once

// The worker's cache of blobs (arrays and manifests of scenes, named by their SHA-256) on disk:
// `<folder>/<digest in hexadecimal>`. Files are written atomically; the least recently used are
// removed when the size limit is exceeded. Several workers of one machine may share a folder: files
// appear by rename, a download holds a lock on its partial file, and a file that is removed during
// a read only has to be fetched again.

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
  /// Creates the folder if necessary. Fails if it cannot be created or used; the error names it.
  static absl::StatusOr<std::unique_ptr<BlobCache>> open(std::string folder,
                                                         std::uint64_t max_bytes);

  bool has(const wire::Digest& digest) const;
  /// Returns the blob and marks it as used. NOT_FOUND: the cache does not have it. DATA_LOSS: the
  /// file was damaged (the digest is checked at each call) or could not be read; it is now removed.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

  /// A download in progress. The bytes written so far are kept when it is destroyed, and the next
  /// download resumes after them.
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
    /// cannot be read again; they are deleted. UNAVAILABLE: the partial file cannot be renamed, as
    /// when a user has removed it.
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
  std::string part_of(const wire::Digest& digest) const;
  /// Opens the partial file `path` for reading and writing, and returns its descriptor. Creates the
  /// file and the cache's folder if they are missing. Errors are those of begin().
  absl::StatusOr<int> open_part(const std::string& path) EXCLUDES(mutex_);
  /// Accounts for `added` bytes and evicts the oldest files until the rest fits. Keeps the file
  /// `newest`.
  void make_room(std::uint64_t added, const std::string& newest) EXCLUDES(mutex_);
  /// Evicts the least recently used files because the disk is full: `wanted` bytes, or more.
  /// Returns false if there is nothing left to evict.
  bool give_up_some(std::uint64_t wanted) EXCLUDES(mutex_);

  const std::string folder_;
  const std::uint64_t max_bytes_;
  BlobFolder blobs_;
  Mutex mutex_;
  /// Size at the last scan of the folder plus what this worker added since.
  std::uint64_t bytes_ GUARDED_BY(mutex_) = 0;
  std::uint64_t added_ GUARDED_BY(mutex_) = 0;  ///< what this worker added since that scan
};

}  // namespace bandsaw::worker
