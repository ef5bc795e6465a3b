// Maps zeroed memory: anonymous memory, or a file without a name whose disk space is reserved at
// once.

#include "renderlib/base/mapped_buffer.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

/// Creates a file without a name in `folder` and reserves `size` bytes of disk space for it.
absl::StatusOr<int> open_unlinked(std::size_t size, const std::string& folder) {
  std::string name = absl::StrCat(folder, "/.bandsaw-XXXXXX");
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) {
    return errno_status(errno, absl::StrCat("cannot make a file in ", folder));
  }
  ::unlink(name.c_str());
  // Without the reservation, a full disk would cause a SIGBUS at the first access to a page.
  // (posix_fallocate is not used: on file systems that cannot reserve space it writes every block.)
  const auto length = static_cast<off_t>(size);
  int result = ::fallocate(file, 0, 0, length);
  if (result != 0 && errno == EOPNOTSUPP) {
    result = ::ftruncate(file, length);
  }
  if (result != 0) {
    const int error = errno;
    ::close(file);
    return errno_status(error, absl::StrCat("cannot reserve ", size, " bytes in ", folder));
  }
  return file;
}

}  // namespace

absl::StatusOr<MappedBuffer> MappedBuffer::create(std::size_t size, const std::string& folder) {
  if (size == 0) {
    return MappedBuffer();
  }
  if (size > static_cast<std::size_t>(std::numeric_limits<off_t>::max())) {
    return absl::ResourceExhaustedError(absl::StrCat("cannot map ", size, " bytes"));
  }
  int file = -1;
  int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  if (!folder.empty()) {
    ASSIGN_OR_RETURN(file, open_unlinked(size, folder));
    flags = MAP_SHARED;
  }
  void* data = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, flags, file, 0);
  const int error = errno;
  if (file >= 0) {
    ::close(file);
  }
  if (data == MAP_FAILED) {
    // Only some Abseil versions map ENOMEM to RESOURCE_EXHAUSTED.
    return absl::ResourceExhaustedError(
        errno_status(error, absl::StrCat("cannot map ", size, " bytes")).message());
  }
  return MappedBuffer(static_cast<std::byte*>(data), size);
}

MappedBuffer::MappedBuffer(MappedBuffer&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedBuffer& MappedBuffer::operator=(MappedBuffer&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

MappedBuffer::~MappedBuffer() {
  if (data_ != nullptr) {
    ::munmap(data_, size_);
  }
}

}  // namespace bandsaw
