#pragma once

// Package -> scene on a worker: each missing blob once into the cache, then decode and build.

#include <atomic>
#include <functional>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "worker/cache/blob_cache.h"
#include "worker/executor/scene_cache.h"

namespace bandsaw::worker {

/// Takes the bytes of a blob as they come; an error ends the transfer.
using TakeBytes = std::function<absl::Status(absl::Span<const std::byte>)>;

/// Sends the blob's bytes from `offset` on to `take`. UNAVAILABLE, DEADLINE_EXCEEDED: try again,
/// from where it broke off.
using TransferBlob = std::function<absl::Status(const wire::Digest& digest, std::uint64_t offset,
                                                const TakeBytes& take)>;

/// Blobs from the cache, and into it when they are not there.
class FetchingSource : public BlobSource {
 public:
  /// All references MUST outlive it.
  FetchingSource(BlobCache& cache, const TransferBlob& transfer, const std::atomic<bool>& stop,
                 const Prepared& prepared)
      : cache_(cache), transfer_(transfer), stop_(stop), prepared_(prepared) {}

  /// CANCELLED: stopped. NOT_FOUND: the coordinator has no such blob. RESOURCE_EXHAUSTED: no room
  /// on the disk. A lost connection is waited out.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;

 private:
  absl::Status fetch(const wire::Digest& digest);
  absl::Status download(const wire::Digest& digest, BlobCache::Download& download);
  void step(std::uint64_t amount) { prepared_(progress_ += amount); }

  BlobCache& cache_;
  const TransferBlob& transfer_;
  const std::atomic<bool>& stop_;
  const Prepared& prepared_;
  std::uint64_t progress_ = 0;
};

/// Errors as above, and INVALID_ARGUMENT: the package is not one that this worker can render.
/// `kernel`: as in Scene::build.
absl::StatusOr<std::shared_ptr<const Scene>> load_package(const wire::Digest& manifest,
                                                          FetchingSource& blobs, Pool& pool,
                                                          const Kernel* kernel = nullptr);

}  // namespace bandsaw::worker
