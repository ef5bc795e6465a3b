// Writes to a temporary file in the folder of the target, syncs it, renames it, and syncs the
// folder.

#include "renderlib/base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

/// Number of names that are tried for the temporary file.
constexpr int kAttempts = 1000;
/// Length of ".4194304.999.part", which contains Linux's largest process id.
constexpr std::size_t kTemporarySuffix = 17;

/// Returns the folder of a path: "a/b" -> "a", "b" -> ".", "/b" -> "/".
std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) {
    return ".";
  }
  return slash == 0 ? "/" : path.substr(0, slash);
}

/// Writes all bytes to the descriptor `file`. Error messages begin with `what`.
absl::Status write_all(int file, absl::Span<const std::byte> bytes, const std::string& what) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return errno_status(errno, what);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return absl::OkStatus();
}

/// An open temporary file.
struct Temporary {
  int file = -1;
  std::string path;
};

/// Creates a new file in the folder of `path`. Its error messages begin with `what`.
/// README.md explains why mkstemp is not used.
absl::StatusOr<Temporary> make_temporary(const std::string& path, const std::string& what) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    std::string name = absl::StrCat(path, ".", ::getpid(), ".", attempt, ".part");
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      return Temporary{file, std::move(name)};
    }
    if (errno != EEXIST) {
      return errno_status(errno, what);
    }
  }
  return errno_status(EEXIST, absl::StrCat(what, ": too many files named *.part beside it"));
}

/// Writes and syncs the file, and closes it in any case. Error messages begin with `what`.
absl::Status fill(int file, absl::Span<const std::byte> bytes, const std::string& what) {
  absl::Status status = write_all(file, bytes, what);
  if (status.ok() && ::fsync(file) != 0) {
    status = errno_status(errno, what);
  }
  // Network file systems report a full disk only here.
  if (::close(file) != 0 && status.ok()) {
    status = errno_status(errno, what);
  }
  return status;
}

}  // namespace

absl::Status write_file_atomically(const std::string& path, absl::Span<const std::byte> bytes) {
  const std::string what = absl::StrCat("cannot write ", path);
  struct stat target {};
  if (::stat(path.c_str(), &target) == 0 && !S_ISREG(target.st_mode)) {
    return absl::FailedPreconditionError(
        absl::StrCat(what, ": it exists and is not a regular file; choose another path"));
  }
  ASSIGN_OR_RETURN(const Temporary temporary, make_temporary(path, what));
  absl::Status status = fill(temporary.file, bytes, what);
  if (status.ok() && ::rename(temporary.path.c_str(), path.c_str()) != 0) {
    status = errno_status(errno, what);
  }
  if (!status.ok()) {
    ::unlink(temporary.path.c_str());
    return status;
  }
  return sync_folder(folder_of(path));
}

absl::Status name_file(const std::string& part, const std::string& path) {
  {
    ASSIGN_OR_RETURN(File file, File::open(part, O_WRONLY));
    RETURN_IF_ERROR(file.sync());
  }
  if (::rename(part.c_str(), path.c_str()) != 0) {
    return errno_status(errno, absl::StrCat("cannot write ", path));
  }
  return sync_folder(folder_of(path));
}

absl::Status check_can_be_written(const std::string& path) {
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode)) {
    return S_ISDIR(info.st_mode)
               ? errno_status(EISDIR, path)
               : absl::FailedPreconditionError(absl::StrCat(path, " is not a regular file"));
  }
  // The temporary file has a longer name than the target.
  if (path.size() - (path.rfind('/') + 1) + kTemporarySuffix > NAME_MAX) {
    return errno_status(ENAMETOOLONG, path);
  }
  const std::string folder = folder_of(path);
  if (::stat(folder.c_str(), &info) != 0) {
    return errno_status(errno, folder);
  }
  if (!S_ISDIR(info.st_mode)) {
    return errno_status(ENOTDIR, folder);
  }
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) != 0) {
    return errno_status(errno, folder);
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
