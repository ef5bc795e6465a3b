// A file that gets its name when it is complete. Disk space is reserved before anything is written;
// a file that is given up is removed, unless leave() keeps its bytes.

#include "coordinator/store/staged_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Reserves disk space. A file system that does not support this reports a full disk at the first
/// write instead.
absl::Status reserve(const File& file, std::uint64_t size, int mode = 0) {
  if (size == 0 || ::fallocate(file.fd(), mode, 0, static_cast<off_t>(size)) == 0 ||
      errno == EOPNOTSUPP || errno == ENOSYS) {
    return absl::OkStatus();
  }
  return errno_status(errno, absl::StrCat("no room for the ", size, " bytes of ", file.path()));
}

}  // namespace

absl::StatusOr<StagedFile> StagedFile::create(const std::string& staging, std::uint64_t size) {
  ASSIGN_OR_RETURN(File file, File::open(staging, O_WRONLY | O_CREAT | O_EXCL));
  StagedFile staged(std::move(file));
  RETURN_IF_ERROR(reserve(staged.file_, size));
  return staged;
}

absl::StatusOr<StagedFile> StagedFile::resume(const std::string& staging, std::uint64_t size,
                                              std::uint64_t offset) {
  // A refused upload MUST NOT leave an empty file, which would count as an interrupted upload.
  absl::StatusOr<File> opened = File::open(staging, offset == 0 ? O_RDWR | O_CREAT : O_RDWR);
  if (absl::IsNotFound(opened.status())) {
    return absl::OutOfRangeError(absl::StrCat("0 bytes are there, not ", offset));
  }
  ASSIGN_OR_RETURN(File file, std::move(opened));
  ASSIGN_OR_RETURN(const std::uint64_t there, file.size());
  if (there < offset) {
    return absl::OutOfRangeError(absl::StrCat(there, " bytes are there, not ", offset));
  }
  StagedFile staged(std::move(file));
  // Extends the file to its full length first, so that a limit on file sizes is detected. Then
  // truncates it to the bytes written and reserves the rest without changing the length: if this
  // process is killed, the length shows how many bytes were written.
  RETURN_IF_ERROR(reserve(staged.file_, size));
  RETURN_IF_ERROR(staged.file_.truncate(offset));
  RETURN_IF_ERROR(reserve(staged.file_, size, FALLOC_FL_KEEP_SIZE));
  if (::lseek(staged.file_.fd(), static_cast<off_t>(offset), SEEK_SET) < 0) {
    return errno_status(errno, staged.file_.path());
  }
  return staged;
}

void StagedFile::leave(std::uint64_t size) { staged_ = !file_.truncate(size).ok(); }

StagedFile::StagedFile(StagedFile&& other) noexcept
    : file_(std::move(other.file_)), staged_(std::exchange(other.staged_, false)) {}

StagedFile::~StagedFile() {
  if (staged_) {
    ::unlink(file_.path().c_str());
  }
}

absl::Status StagedFile::commit(const std::string& folder, const std::string& target) {
  RETURN_IF_ERROR(file_.sync());
  if (::rename(file_.path().c_str(), target.c_str()) != 0) {
    return errno_status(errno, absl::StrCat("cannot rename ", file_.path(), " to ", target));
  }
  staged_ = false;
  return sync_folder(folder);
}

}  // namespace bandsaw::coordinator
