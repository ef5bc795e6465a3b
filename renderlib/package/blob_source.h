#pragma once

// Where the bytes behind a digest come from: a folder, a worker's cache, a test's map. One of the
// four open doors.

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

/// Bytes that stay valid while the object lives (memory, or a mapped file).
class BlobBytes {
 public:
  virtual ~BlobBytes() = default;
  virtual absl::Span<const std::byte> bytes() const = 0;
};

class BlobSource {
 public:
  virtual ~BlobSource() = default;
  /// NOT_FOUND: no such blob. DATA_LOSS: there is one, but its bytes do not have the digest.
  virtual absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) = 0;
};

/// Blobs in memory: what the importer fills, and tests.
class BlobMap : public BlobSource {
 public:
  wire::Digest put(SharedBytes bytes);
  wire::Digest put(std::vector<std::byte> bytes) { return put(SharedBytes(std::move(bytes))); }
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override;
  const std::map<wire::Digest, SharedBytes>& all() const { return blobs_; }

 private:
  std::map<wire::Digest, SharedBytes> blobs_;
};

}  // namespace bandsaw
