// Opens the data folder: takes its lock, and checks its format. The lock is an flock on a file that
// also holds the process id, for the message to a second coordinator.

#include "coordinator/store/data_folder.h"

#include <sys/file.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "coordinator/store/staged_file.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr absl::string_view kFormat = "bandsaw data 1\n";
/// Bytes that are really written to test the disk; the rest of the space is only reserved.
constexpr std::size_t kProbeBytes = 1 << 16;

/// Reads at most `limit` bytes of a small file.
absl::StatusOr<std::string> read_text(const File& file, std::uint64_t limit) {
  ASSIGN_OR_RETURN(const std::uint64_t size, file.size());
  std::string text(std::min(size, limit), '\0');
  RETURN_IF_ERROR(
      file.read(0, absl::MakeSpan(reinterpret_cast<std::byte*>(text.data()), text.size())));
  return text;
}

/// Locks the folder's lock file, and writes the process id into it. FAILED_PRECONDITION: another
/// coordinator holds the lock.
absl::StatusOr<File> take_lock(const std::string& path) {
  ASSIGN_OR_RETURN(File lock, File::open(path + "/lock", O_RDWR | O_CREAT));
  if (::flock(lock.fd(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      return errno_status(errno, absl::StrCat("cannot lock ", lock.path()));
    }
    const absl::StatusOr<std::string> holder = read_text(lock, 32);
    return absl::FailedPreconditionError(absl::StrCat(
        "another coordinator (process ", holder.ok() ? absl::StripAsciiWhitespace(*holder) : "?",
        ") uses the data folder ", path, "; stop it, or choose another folder with --data"));
  }
  // All texts have the same length, so the text of an earlier process is overwritten. This needs no
  // space on a full disk.
  const std::string holder = absl::StrFormat("%-20d\n", ::getpid());
  const absl::Status written = lock.write(std::as_bytes(std::span(holder)));
  // The text is for users; the lock works without it.
  return absl::IsResourceExhausted(written) || written.ok() ? absl::StatusOr<File>(std::move(lock))
                                                            : written;
}

/// Writes the format into a new folder, and refuses a folder with another format.
absl::Status check_format(const std::string& path) {
  const std::string name = path + "/format";
  if (!file_exists(name)) {
    if (file_exists(path + "/journal.sqlite")) {
      return absl::DataLossError(absl::StrCat(
          name, " is missing beside a journal; restore it, or choose another folder with --data"));
    }
    return write_file_atomically(name, std::as_bytes(std::span(kFormat)));
  }
  ASSIGN_OR_RETURN(const File file, File::open(name, O_RDONLY));
  ASSIGN_OR_RETURN(const std::string found, read_text(file, 100));
  if (found != kFormat) {
    return absl::FailedPreconditionError(absl::StrCat(
        "the data folder ", path, " has the format '", absl::StripAsciiWhitespace(found),
        "', this program knows '", absl::StripAsciiWhitespace(kFormat),
        "'; use the version that wrote it, or another folder with --data"));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<DataFolder> DataFolder::open(const std::string& path) {
  RETURN_IF_ERROR(make_folder(path));
  ASSIGN_OR_RETURN(File lock, take_lock(path));
  RETURN_IF_ERROR(check_format(path));
  DataFolder folder(path, std::move(lock));
  RETURN_IF_ERROR(make_folder(folder.blobs()));
  RETURN_IF_ERROR(make_folder(folder.jobs()));
  RETURN_IF_ERROR(sync_folder(path));
  return folder;
}

std::string DataFolder::job(JobId id) const { return absl::StrCat(jobs(), "/", id); }

absl::Status probe_disk(const std::string& folder, std::uint64_t bytes) {
  const std::string name = folder + "/probe";
  RETURN_IF_ERROR(remove_file(name));
  ASSIGN_OR_RETURN(StagedFile file, StagedFile::create(name, bytes));
  RETURN_IF_ERROR(file.append(std::vector<std::byte>(kProbeBytes)));
  return file.sync();
}

absl::StatusOr<std::uint64_t> free_bytes(const std::string& folder) {
  struct statvfs found {};
  if (::statvfs(folder.c_str(), &found) != 0) {
    return errno_status(errno, folder);
  }
  return static_cast<std::uint64_t>(found.f_bavail) * found.f_frsize;
}

}  // namespace bandsaw::coordinator
