#pragma once

// Blobs by digest, as files. Thread-safe; calls may block on the disk.

#include <atomic>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "coordinator/store/staged_file.h"
#include "proto/wire/digest.h"
#include "renderlib/base/mutex.h"
#include "renderlib/package/blob_source.h"

namespace bandsaw::coordinator {

class BlobStore : public BlobSource {
 public:
  /// `folder` MUST exist and belong to this store. What interrupted uploads left there is removed.
  static absl::StatusOr<std::unique_ptr<BlobStore>> open(const std::string& folder);

  bool has(const wire::Digest& digest) const;

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

  /// A blob that arrives in pieces. Without commit nothing is kept.
  class Writer {
   public:
    /// INVALID_ARGUMENT: more than the announced size. RESOURCE_EXHAUSTED: the disk is full.
    absl::Status append(absl::Span<const std::byte> bytes);
    /// INVALID_ARGUMENT: digest or size differ. OK: on disk.
    absl::Status commit();

   private:
    friend class BlobStore;
    Writer(std::string folder, const wire::Digest& digest, std::uint64_t size, StagedFile file)
        : folder_(std::move(folder)), digest_(digest), size_(size), file_(std::move(file)) {}
    std::string folder_;
    wire::Digest digest_;
    std::uint64_t size_ = 0;
    std::uint64_t written_ = 0;
    wire::Hasher hasher_;
    StagedFile file_;
  };
  /// RESOURCE_EXHAUSTED: over the limit of a blob, or no room for it.
  absl::StatusOr<Writer> write(const wire::Digest& digest, std::uint64_t size);

 private:
  explicit BlobStore(std::string folder) : folder_(std::move(folder)) {}
  absl::Status check(const wire::Digest& digest, absl::Span<const std::byte> bytes)
      EXCLUDES(mutex_);

  std::string folder_;
  std::atomic<std::uint64_t> uploads_{0};
  Mutex mutex_;
  std::set<wire::Digest> checked_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
