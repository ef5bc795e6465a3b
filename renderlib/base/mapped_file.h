#pragma once

// A memory-mapped, read-only file.

#include <cstddef>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

class File;  // renderlib/base/file.h

/// The file MUST NOT be truncated while it is mapped; it may be replaced or removed.
class MappedFile {
 public:
  /// `flags` and errors are those of File::open_regular: NOT_FOUND if the file does not exist,
  /// INVALID_ARGUMENT if it is not a regular file.
  static absl::StatusOr<MappedFile> open(const std::string& path, int flags = 0);
  /// Maps the whole of an open file, which may be closed afterwards. Returns the system's error.
  static absl::StatusOr<MappedFile> map(const File& file);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&&) = delete;
  ~MappedFile();
  absl::Span<const std::byte> bytes() const { return {data_, size_}; }

 private:
  MappedFile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace bandsaw
