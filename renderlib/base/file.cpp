// Wrappers of system calls, which return errors as statuses. Opening, reading and writing are
// repeated if a signal interrupts them.

#include "renderlib/base/file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {

absl::Status errno_status(int error, const std::string& what) {
  if (error == EFBIG) {  // a limit on file sizes is treated like a full disk
    return absl::ResourceExhaustedError(absl::ErrnoToStatus(error, what).message());
  }
  return absl::ErrnoToStatus(error, what);
}

bool is_unreadable(const absl::Status& status) {
  return absl::IsUnknown(status);  // the canonical status of EIO
}

absl::StatusOr<File> File::open(const std::string& path, int flags) {
  int fd = -1;
  do {
    fd = ::open(path.c_str(), flags | O_CLOEXEC, 0600);
  } while (fd < 0 && errno == EINTR);
  if (fd < 0) {
    return errno_status(errno, absl::StrCat("cannot open ", path));
  }
  return File(fd, path);
}

absl::StatusOr<File> File::open_regular(const std::string& path, int flags) {
  ASSIGN_OR_RETURN(File file, open(path, O_RDONLY | O_NONBLOCK | flags));
  struct stat info {};
  if (::fstat(file.fd_, &info) != 0) {
    return errno_status(errno, path);
  }
  if (!S_ISREG(info.st_mode)) {
    return absl::InvalidArgumentError(absl::StrCat(path, ": is not a file"));
  }
  return file;
}

File& File::operator=(File&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(path_, other.path_);
  return *this;
}

File::~File() {
  if (fd_ >= 0) {
    ::close(fd_);
  }
}

absl::Status File::write(absl::Span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      return errno_status(errno, absl::StrCat("cannot write ", path_));
    }
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return absl::OkStatus();
}

absl::Status File::read(std::uint64_t offset, absl::Span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      return errno_status(errno, absl::StrCat("cannot read ", path_));
    }
    if (n == 0) {
      return absl::DataLossError(absl::StrCat(path_, " ends at byte ", offset, ", ", bytes.size(),
                                              " bytes before it should"));
    }
    offset += static_cast<std::uint64_t>(n);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return absl::OkStatus();
}

absl::Status File::sync() {
  if (::fdatasync(fd_) != 0) {
    return errno_status(errno, absl::StrCat("cannot sync ", path_));
  }
  return absl::OkStatus();
}

absl::Status File::truncate(std::uint64_t size) {
  if (::ftruncate(fd_, static_cast<off_t>(size)) != 0) {
    return errno_status(errno, absl::StrCat("cannot cut ", path_, " to ", size, " bytes"));
  }
  return absl::OkStatus();
}

absl::StatusOr<std::uint64_t> File::size() const {
  struct stat info {};
  if (::fstat(fd_, &info) != 0) {
    return errno_status(errno, absl::StrCat("cannot read the size of ", path_));
  }
  return static_cast<std::uint64_t>(info.st_size);
}

absl::StatusOr<std::string> read_whole_file(const std::string& path, std::uint64_t most_bytes) {
  ASSIGN_OR_RETURN(const File file, File::open_regular(path));
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  if (size > most_bytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat(path, ": has ", size, " bytes, at most ", most_bytes, " are read"));
  }
  std::string bytes(size, '\0');
  RETURN_IF_ERROR(
      file.read(0, absl::MakeSpan(reinterpret_cast<std::byte*>(bytes.data()), bytes.size())));
  return bytes;
}

absl::Status make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
    return errno_status(errno, absl::StrCat("cannot make the folder ", path));
  }
  return absl::OkStatus();
}

absl::Status sync_folder(const std::string& path) {
  ASSIGN_OR_RETURN(const File folder, File::open(path, O_RDONLY | O_DIRECTORY));
  // Some file systems cannot sync folders; that is not an error.
  if (::fsync(folder.fd()) != 0 && errno != EINVAL && errno != EROFS) {
    return errno_status(errno, absl::StrCat("cannot sync the folder ", path));
  }
  return absl::OkStatus();
}

bool file_exists(const std::string& path) { return ::access(path.c_str(), F_OK) == 0; }

absl::Status remove_file(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
    return errno_status(errno, absl::StrCat("cannot remove ", path));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
