// Maps a whole file for reading; an empty file has no mapping.

#include "renderlib/base/mapped_file.h"

#include <sys/mman.h>

#include <cerrno>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {

absl::StatusOr<MappedFile> MappedFile::open(const std::string& path, int flags) {
  ASSIGN_OR_RETURN(const File file, File::open_regular(path, flags));
  return map(file);
}

absl::StatusOr<MappedFile> MappedFile::map(const File& file) {
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  if (size == 0) {
    return MappedFile(nullptr, 0);
  }
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd(), 0);
  if (data == MAP_FAILED) {
    return errno_status(errno, absl::StrCat("cannot map ", file.path()));
  }
  return MappedFile(static_cast<const std::byte*>(data), size);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile::~MappedFile() {
  if (data_ != nullptr) {
    ::munmap(const_cast<std::byte*>(data_), size_);
  }
}

}  // namespace bandsaw
