#pragma once

// Immutable bytes with shared ownership: used for blobs, mapped files and the texels of a scene.
// Copying an object copies a reference, not the bytes.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "absl/types/span.h"

namespace bandsaw {

class SharedBytes {
 public:
  using value_type = std::byte;

  /// Empty.
  SharedBytes() = default;
  /// Takes ownership of the vector.
  SharedBytes(std::vector<std::byte> bytes) {  // NOLINT: implicit on purpose
    auto owner = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    bytes_ = absl::MakeConstSpan(*owner);
    owner_ = std::move(owner);
  }
  /// Refers to `bytes`, which are valid as long as `owner` exists.
  SharedBytes(std::shared_ptr<const void> owner, absl::Span<const std::byte> bytes)
      : owner_(std::move(owner)), bytes_(bytes) {}

  const std::byte* data() const { return bytes_.data(); }
  std::size_t size() const { return bytes_.size(); }
  bool empty() const { return bytes_.empty(); }
  std::byte operator[](std::size_t i) const { return bytes_[i]; }
  const std::byte* begin() const { return bytes_.data(); }
  const std::byte* end() const { return bytes_.data() + bytes_.size(); }
  absl::Span<const std::byte> span() const { return bytes_; }

  /// Compares the bytes, not their addresses.
  friend bool operator==(const SharedBytes& a, const SharedBytes& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  std::shared_ptr<const void> owner_;
  absl::Span<const std::byte> bytes_;
};

}  // namespace bandsaw
