#pragma once

// Conversion between arrays and the bytes of blobs (flat arrays, the parts of a scene package).
// Blobs are little-endian, and so is every supported machine.

#include <bit>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <vector>

#include "absl/types/span.h"

namespace bandsaw {

static_assert(std::endian::native == std::endian::little, "blobs are copied, not converted");

/// Returns the bytes of an array.
template <class T>
std::vector<std::byte> to_bytes(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) {
    std::memcpy(bytes.data(), values.data(), bytes.size());
  }
  return bytes;
}

/// Returns the array whose bytes are `bytes`. `bytes.size()` MUST be a multiple of sizeof(T).
template <class T>
std::vector<T> from_bytes(absl::Span<const std::byte> bytes) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) {
    std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
  }
  return values;
}

}  // namespace bandsaw
