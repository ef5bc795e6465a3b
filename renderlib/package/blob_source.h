#pragma once

// Interface that returns the bytes of a blob, given its digest (SHA-256). A blob is a flat array to
// which the manifest of a scene package refers. A folder, a worker's cache and a map in memory
// implement the interface.

#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "proto/wire/digest.h"
#include "renderlib/base/shared_bytes.h"

namespace bandsaw {

/// Bytes that are valid as long as the object exists (memory, or a mapped file).
class BlobBytes {
 public:
  virtual ~BlobBytes() = default;
  virtual absl::Span<const std::byte> bytes() const = 0;
};

class BlobSource {
 public:
  virtual ~BlobSource() = default;
  /// Returns NOT_FOUND if there is no such blob, and DATA_LOSS if its bytes do not have the digest.
  virtual absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) = 0;
};

/// Blobs in memory; used by the importer and by tests.
class BlobMap : public BlobSource {
 public:
  /// Adds a blob and returns its digest.
  wire::Digest put(SharedBytes bytes);
  wire::Digest put(std::vector<std::byte> bytes) { return put(SharedBytes(std::move(bytes))); }
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  const std::map<wire::Digest, SharedBytes>& all() const { return blobs_; }

 private:
  std::map<wire::Digest, SharedBytes> blobs_;
};

}  // namespace bandsaw
