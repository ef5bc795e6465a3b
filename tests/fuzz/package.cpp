// Fuzz target (fuzz.h): a scene package, which is a manifest and the blobs that it names. The input
// is the length of the manifest (two bytes, little-endian), the manifest, and the bytes that every
// blob has.

#include "renderlib/package/package.h"

#include <algorithm>
#include <span>

#include "tests/fuzz/fuzz.h"

namespace {

/// The bytes of a blob.
class OneBlob : public bandsaw::BlobBytes {
 public:
  explicit OneBlob(absl::Span<const std::byte> bytes) : bytes_(bytes) {}
  absl::Span<const std::byte> bytes() const override { return bytes_; }

 private:
  absl::Span<const std::byte> bytes_;
};

/// Has every blob, always with the same bytes.
class AnyBlob : public bandsaw::BlobSource {
 public:
  explicit AnyBlob(absl::Span<const std::byte> bytes) : bytes_(bytes) {}
  absl::StatusOr<std::unique_ptr<bandsaw::BlobBytes>> get(const bandsaw::wire::Digest&) override {
    return std::make_unique<OneBlob>(bytes_);
  }

 private:
  absl::Span<const std::byte> bytes_;
};

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  if (input.size() < 2) {
    return;
  }
  const std::size_t length = std::min<std::size_t>(input[0] + 256u * input[1], input.size() - 2);
  const std::string manifest = text(input.subspan(2, length));
  const auto rest = std::as_bytes(std::span(input.data() + 2 + length, input.size() - 2 - length));
  AnyBlob blobs({rest.data(), rest.size()});
  package_info(manifest).IgnoreError();
  package_blobs(manifest).IgnoreError();
  decode_package(manifest, blobs).IgnoreError();
}
