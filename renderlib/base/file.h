#pragma once

// The few calls to the file system that are needed, as values and statuses.

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

/// The canonical status for an errno: ENOENT NOT_FOUND, EACCES PERMISSION_DENIED, ENOSPC
/// RESOURCE_EXHAUSTED, …; the message is "what: strerror".
absl::Status errno_status(int error, const std::string& what);

/// An open file descriptor that closes itself.
class File {
 public:
  /// `flags` as open(2) takes them; O_CLOEXEC is added, a new file is readable by its owner alone.
  static absl::StatusOr<File> open(const std::string& path, int flags);
  /// To read. INVALID_ARGUMENT: not a regular file; nothing waits for the writer of a pipe.
  static absl::StatusOr<File> open_regular(const std::string& path, int flags = 0);
  File(File&& other) noexcept : fd_(std::exchange(other.fd_, -1)), path_(std::move(other.path_)) {}
  File& operator=(File&& other) noexcept;
  ~File();

  /// All of it, at the file's position. RESOURCE_EXHAUSTED: no space; a part may have been written.
  absl::Status write(absl::Span<const std::byte> bytes);
  /// Exactly so many bytes from `offset`. DATA_LOSS: the file is shorter.
  absl::Status read(std::uint64_t offset, absl::Span<std::byte> bytes) const;
  /// Data (and the size) on disk.
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

/// A regular file's bytes. RESOURCE_EXHAUSTED: larger than `most_bytes`. Never blocks on a pipe or
/// device.
absl::StatusOr<std::string> read_whole_file(const std::string& path, std::uint64_t most_bytes);
/// Makes the folder (0700) unless it is there.
absl::Status make_folder(const std::string& path);
/// Names made, renamed or removed in the folder are on disk.
absl::Status sync_folder(const std::string& path);
bool file_exists(const std::string& path);
/// Removes a file; fine when it is not there.
absl::Status remove_file(const std::string& path);

}  // namespace bandsaw
