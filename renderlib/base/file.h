#pragma once

// File system calls that return values and statuses.

#include <fcntl.h>
#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

/// Returns the canonical status for an errno: ENOENT is NOT_FOUND, EACCES PERMISSION_DENIED, ENOSPC
/// RESOURCE_EXHAUSTED, …; the message is "what: strerror". EFBIG, a limit on the size of a file, is
/// RESOURCE_EXHAUSTED like a full disk.
absl::Status errno_status(int error, const std::string& what);

/// Returns true if `status`, which a function of File returned, says that the disk cannot read a
/// sector (EIO).
bool is_unreadable(const absl::Status& status);

/// An open file descriptor that closes itself.
class File {
 public:
  /// Opens a file with the `flags` of open(2); O_CLOEXEC is added. A new file has mode 0600. If a
  /// comment names no other error, the functions of this file return that of errno_status().
  static absl::StatusOr<File> open(const std::string& path, int flags);
  /// Opens a file for reading; `flags` are further flags of open(2). Returns INVALID_ARGUMENT if it
  /// is not a regular file; does not wait for the writer of a pipe.
  static absl::StatusOr<File> open_regular(const std::string& path, int flags = 0);
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)) {}
  File& operator=(File&& other) noexcept;
  ~File();

  /// Writes all bytes at the file's position. Returns RESOURCE_EXHAUSTED if there is no space; a
  /// part may have been written.
  absl::Status write(absl::Span<const std::byte> bytes);
  /// Reads exactly `bytes.size()` bytes from `offset`. Returns DATA_LOSS if the file is shorter.
  absl::Status read(std::uint64_t offset, absl::Span<std::byte> bytes) const;
  /// Waits until the data and the size are on disk.
  absl::Status sync();
  absl::Status truncate(std::uint64_t size);
  absl::StatusOr<std::uint64_t> size() const;

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }

 private:
  File(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  int fd_ = -1;
  std::string path_;
};

/// Returns a regular file's bytes. Returns RESOURCE_EXHAUSTED if it is larger than `most_bytes`.
/// Never blocks on a pipe or device.
absl::StatusOr<std::string> read_whole_file(const std::string& path, std::uint64_t most_bytes);
/// Creates the folder (mode 0700) unless it exists.
absl::Status make_folder(const std::string& path);
/// Waits until creations, renames and removals in the folder are on disk.
absl::Status sync_folder(const std::string& path);
bool file_exists(const std::string& path);
/// Removes a file; OK if it does not exist.
absl::Status remove_file(const std::string& path);

}  // namespace bandsaw
