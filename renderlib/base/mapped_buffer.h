#pragma once

// Large memory that the operating system provides page by page: anonymous, or backed by a file, so
// that the system can write pages to disk instead of filling memory. The file has no name and
// disappears with the buffer, also after a crash. Films keep their sums in it (render/row_store.h).

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

class MappedBuffer {
 public:
  /// Empty: size 0.
  MappedBuffer() = default;

  /// Creates a buffer of `size` zero bytes, aligned to pages. If `folder` is empty, the memory is
  /// anonymous, and a page is allocated when it is first touched. Otherwise the memory is backed by
  /// a file in `folder`. The disk space of the file is reserved now, so that an access to the
  /// memory cannot fail later. Returns RESOURCE_EXHAUSTED if there is no memory or disk space, and
  /// NOT_FOUND or PERMISSION_DENIED if the folder cannot be used.
  static absl::StatusOr<MappedBuffer> create(std::size_t size, const std::string& folder);

  MappedBuffer(MappedBuffer&& other) noexcept;
  MappedBuffer& operator=(MappedBuffer&& other) noexcept;
  ~MappedBuffer();

  std::size_t size() const { return size_; }
  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }

  /// Returns the buffer as an array of T; zero bytes MUST be a valid value of T.
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
