#pragma once

// Large memory that the operating system gives page by page: anonymous, or backed by a file so that
// it may be written out instead of filling memory. The file has no name: it is gone when the buffer
// is, also after a crash.

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

class MappedBuffer {
 public:
  /// Nothing: size 0.
  MappedBuffer() = default;

  /// `size` zero bytes, aligned to pages. `folder` empty: anonymous memory, taken from the system
  /// as it is touched. Otherwise a file in `folder`, its disk space reserved now, so that touching
  /// it cannot fail later. RESOURCE_EXHAUSTED: no memory or disk; NOT_FOUND, PERMISSION_DENIED: the
  /// folder.
  static absl::StatusOr<MappedBuffer> create(std::size_t size, const std::string& folder);

  MappedBuffer(MappedBuffer&& other) noexcept;
  MappedBuffer& operator=(MappedBuffer&& other) noexcept;
  ~MappedBuffer();

  std::size_t size() const { return size_; }
  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }

  /// As numbers; T MUST be a type for which zero bytes are a value.
  template <class T>
  absl::Span<T> as() {
    return {reinterpret_cast<T*>(data_), size_ / sizeof(T)};
  }
  template <class T>
  absl::Span<const T> as() const {
    return {reinterpret_cast<const T*>(data_), size_ / sizeof(T)};
  }

 private:
  MappedBuffer(std::byte* data, std::size_t size) : data_(data), size_(size) {}
  std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace bandsaw
