#pragma once

// Blobs by digest, as files. Thread-safe; calls may block on the disk.

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
#include "renderlib/base/mutex.h"
#include "renderlib/package/blob_source.h"

namespace bandsaw::coordinator {

class BlobStore : public BlobSource {
 public:
  /// `folder` MUST exist and belong to this store.
  static absl::StatusOr<std::unique_ptr<BlobStore>> open(const std::string& folder);

  bool has(const wire::Digest& digest) const;
  /// How many bytes of a blob that is not there are kept of an upload that was cut.
  std::uint64_t partial(const wire::Digest& digest) const { return partials_->size(digest); }

  /// The blob, mapped. Its digest is checked the first time in this life. NOT_FOUND: no such blob.
  /// DATA_LOSS: the file is damaged; it has been removed, so that the blob can be sent again.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

  struct Stored {
    wire::Digest digest;
    std::uint64_t size = 0;
    double used_at = 0;  ///< seconds since 1970: written or touched last
  };
  /// All blobs, in no order. Those that come or go meanwhile may be among them.
  std::vector<Stored> list() const;
  /// It is needed now, as if it had just come.
  void touch(const wire::Digest& digest) const;
  /// Fine when it is not there. Who has it mapped keeps it.
  absl::Status remove(const wire::Digest& digest) EXCLUDES(mutex_);

  /// Partial blobs that nobody wrote to for so long go. `now`: seconds since 1970.
  void remove_partials(double now, double seconds) { partials_->remove_unused(now, seconds); }

  /// A blob that arrives in pieces. Without commit its bytes are kept as a partial blob, unless
  /// something was wrong with them. The store MUST outlive it.
  class Writer {
   public:
    Writer(Writer&&) noexcept = default;
    ~Writer();
    /// INVALID_ARGUMENT: more than the announced size. RESOURCE_EXHAUSTED: the disk is full.
    absl::Status append(absl::Span<const std::byte> bytes);
    /// INVALID_ARGUMENT: digest or size differ. DATA_LOSS: the digest does, and some of the bytes
    /// are of an earlier upload: they may have been damaged since. OK: on disk.
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
    std::uint64_t earlier_ = 0;  ///< bytes of an earlier upload
    std::uint64_t written_ = 0;  ///< with those
    bool intact_ = true;
    wire::Hasher hasher_;
    std::unique_ptr<PartialBlobs::Claim> claim_;  ///< goes after the file; none: moved from
    StagedFile file_;
  };
  /// `offset`: goes on behind so many bytes of an earlier upload. FAILED_PRECONDITION: there are
  /// fewer. RESOURCE_EXHAUSTED: over the limit of a blob, or no room for it.
  absl::StatusOr<Writer> write(const wire::Digest& digest, std::uint64_t size,
                               std::uint64_t offset = 0);

 private:
  BlobStore(std::string folder, std::unique_ptr<PartialBlobs> partials)
      : folder_(std::move(folder)), partials_(std::move(partials)) {}
  absl::Status check(const wire::Digest& digest, absl::Span<const std::byte> bytes)
      EXCLUDES(mutex_);

  std::string folder_;
  std::unique_ptr<PartialBlobs> partials_;
  Mutex mutex_;
  std::set<wire::Digest> checked_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
