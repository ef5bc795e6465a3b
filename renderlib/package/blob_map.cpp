// Implements BlobMap, which keeps blobs (flat arrays of scene packages) in memory, by their
// digests.

#include "renderlib/package/blob_source.h"

#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

class InMemory : public BlobBytes {
 public:
  explicit InMemory(SharedBytes bytes) : bytes_(std::move(bytes)) {}
  absl::Span<const std::byte> bytes() const override { return bytes_.span(); }

 private:
  SharedBytes bytes_;
};

}  // namespace

wire::Digest BlobMap::put(SharedBytes bytes) {
  const wire::Digest digest = wire::sha256(bytes.span());
  blobs_.try_emplace(digest, std::move(bytes));
  return digest;
}

absl::StatusOr<std::unique_ptr<BlobBytes>> BlobMap::get(const wire::Digest& digest) {
  const auto found = blobs_.find(digest);
  if (found == blobs_.end()) {
    return absl::NotFoundError(absl::StrCat("blob ", digest.hex(), " is missing"));
  }
  return std::make_unique<InMemory>(found->second);
}

}  // namespace bandsaw
