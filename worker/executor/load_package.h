#pragma once

// Loads the scene of a package (a manifest and the blobs that it names by their digests). Fetches
// each missing blob into the cache, decodes the package and builds the scene.

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/package/decoded_parts.h"
#include "worker/cache/blob_cache.h"
#include "worker/executor/scene_cache.h"

namespace bandsaw::worker {

/// Receives the next bytes of a blob; an error ends the transfer.
using TakeBytes = std::function<absl::Status(absl::Span<const std::byte>)>;

/// Calls `take` with all bytes of the blob from `offset` to the end. UNAVAILABLE,
/// DEADLINE_EXCEEDED: the caller should try again from the first missing byte. INVALID_ARGUMENT:
/// the blob has fewer than `offset` bytes.
using TransferBlob = std::function<absl::Status(const wire::Digest& digest, std::uint64_t offset,
                                                const TakeBytes& take)>;

/// Reads blobs from the cache, fetching those that are missing.
class FetchingSource : public BlobSource {
 public:
  /// `stop`: set by another thread to cancel. `prepared`: gets the progress, which is the sum of
  /// the bytes fetched, the blobs read, the short waits for another worker's download, and the
  /// amounts that step() adds. All references MUST outlive this object.
  FetchingSource(BlobCache& cache, const TransferBlob& transfer, const std::atomic<bool>& stop,
                 const Prepared& prepared)
      : cache_(cache), transfer_(transfer), stop_(stop), prepared_(prepared) {}

  /// CANCELLED: stopped. NOT_FOUND: the coordinator has no such blob. RESOURCE_EXHAUSTED: the disk
  /// is full. If the connection is lost, waits for the next one.
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  /// Adds `amount` to the progress, and reports the sum.
  void step(std::uint64_t amount) { prepared_(progress_ += amount); }

 private:
  /// Downloads a blob into the cache. Repeats transfers that are interrupted, and waits while
  /// another worker downloads the blob.
  absl::Status fetch(const wire::Digest& digest);
  /// Makes one transfer, from the end of the partial file, and commits the blob.
  absl::Status download(const wire::Digest& digest, BlobCache::Download& partial);

  BlobCache& cache_;
  const TransferBlob& transfer_;
  const std::atomic<bool>& stop_;
  const Prepared& prepared_;
  std::uint64_t progress_ = 0;
};

/// Builds scenes. A scene may share parts (meshes with their BVHs, texels, grids) with earlier
/// scenes that are still in use. These parts are neither read nor built again. So loading a frame
/// of a sequence takes time only for the parts that have changed.
class PackageLoader {
 public:
  /// `kernel`: the code that builds and renders the scenes, one of kernels()
  /// (renderlib/render/kernel.h); nullptr: the first of them. `pool` MUST outlive the loader.
  explicit PackageLoader(Pool& pool, const Kernel* kernel = nullptr)
      : pool_(pool), kernel_(kernel) {}
  /// Builds the scene. The errors are those of FetchingSource::get. In addition, INVALID_ARGUMENT:
  /// this worker cannot render the package. MUST NOT be called by two threads at a time.
  absl::StatusOr<std::shared_ptr<const Scene>> load(const wire::Digest& manifest,
                                                    FetchingSource& blobs);

 private:
  /// Returns the earlier scenes that still exist, and forgets the others.
  std::vector<std::shared_ptr<const Scene>> scenes_in_use();

  Pool& pool_;
  const Kernel* const kernel_;
  DecodedParts parts_;
  std::vector<std::weak_ptr<const Scene>> scenes_;
};

}  // namespace bandsaw::worker
