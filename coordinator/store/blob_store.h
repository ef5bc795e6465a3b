#pragma once

// Stores blobs (pieces of scene data, named by their SHA-256) as files. Thread-safe; calls may
// block on the disk.

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "coordinator/store/partial_blobs.h"
#include "coordinator/store/staged_file.h"
#include "proto/wire/digest.h"
#include "renderlib/base/file.h"
#include "renderlib/base/mutex.h"
#include "renderlib/package/blob_source.h"

namespace bandsaw::coordinator {

class BlobStore : public BlobSource {
 public:
  /// `folder` MUST exist and be used by this store only.
  static absl::StatusOr<std::unique_ptr<BlobStore>> open(const std::string& folder);

  /// Returns true if the whole blob is stored.
  bool has(const wire::Digest& digest) const;
  /// Returns the number of bytes that are kept of an interrupted upload of the blob. Returns 0 if
  /// none are kept, or while an upload of the blob is in progress.
  std::uint64_t partial(const wire::Digest& digest) const { return partials_->size(digest); }

  /// Returns the blob, memory-mapped. Its digest is checked at the first call since the process
  /// started. NOT_FOUND: no such blob. DATA_LOSS: the file is damaged or cannot be read; it was
  /// removed, so that the blob can be uploaded again.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

  struct Stored {
    wire::Digest digest;
    std::uint64_t size = 0;
    double used_at = 0;  ///< seconds since 1970: last written or touched
  };
  /// Returns all blobs, in no order. Blobs added or removed during the call may be listed or not.
  std::vector<Stored> list() const;
  /// Marks the blob as just used.
  void touch(const wire::Digest& digest) const;
  /// Removes the blob; OK if it does not exist. Existing mappings stay valid.
  absl::Status remove(const wire::Digest& digest) EXCLUDES(mutex_);

  /// Removes partial blobs that were not written to for `seconds`. `now`: seconds since 1970.
  void remove_partials(double now, double seconds) { partials_->remove_unused(now, seconds); }

  /// Writes a blob that arrives in pieces. If a Writer is destroyed without commit(), the bytes are
  /// kept as a partial blob, unless an error occurred. The store MUST outlive the Writer.
  class Writer {
   public:
    Writer(Writer&&) noexcept = default;
    ~Writer();
    /// INVALID_ARGUMENT: more bytes than announced. RESOURCE_EXHAUSTED: the disk is full.
    absl::Status append(absl::Span<const std::byte> bytes);
    /// OK: the blob is on disk. INVALID_ARGUMENT: the digest or the size differs. DATA_LOSS: the
    /// digest differs and some of the bytes are from an earlier upload, so they may have been
    /// damaged since.
    absl::Status commit();

   private:
    friend class BlobStore;
    Writer(std::string folder, const wire::Digest& digest, std::uint64_t size,
           std::unique_ptr<PartialBlobs::Claim> claim, StagedFile file)
        : folder_(std::move(folder)),
          digest_(digest),
          size_(size),
          claim_(std::move(claim)),
          file_(std::move(file)) {}
    absl::Status take_earlier(std::uint64_t bytes);
    std::string folder_;
    wire::Digest digest_;
    std::uint64_t size_ = 0;
    std::uint64_t earlier_ = 0;  ///< bytes from an earlier upload
    std::uint64_t written_ = 0;  ///< bytes in the file, those of the earlier upload included
    bool intact_ = true;         ///< the bytes are worth keeping as a partial blob
    wire::Hasher hasher_;
    /// Released after the file is closed; nullptr after a move.
    std::unique_ptr<PartialBlobs::Claim> claim_;
    StagedFile file_;
  };
  /// Starts writing a blob. `offset` > 0 resumes after that many bytes of an earlier upload.
  /// FAILED_PRECONDITION: fewer bytes are stored. RESOURCE_EXHAUSTED: the blob is too large, or the
  /// disk has no space for it.
  absl::StatusOr<Writer> write(const wire::Digest& digest, std::uint64_t size,
                               std::uint64_t offset = 0);

 private:
  BlobStore(std::string folder, std::unique_ptr<PartialBlobs> partials)
      : folder_(std::move(folder)), partials_(std::move(partials)) {}
  /// Checks the digest of the blob's open file, unless it was checked before. DATA_LOSS: the file
  /// is damaged or cannot be read, and was removed.
  absl::Status check(const wire::Digest& digest, const File& file) EXCLUDES(mutex_);

  std::string folder_;
  std::unique_ptr<PartialBlobs> partials_;
  Mutex mutex_;
  /// Blobs whose digest was checked by get().
  std::set<wire::Digest> checked_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
