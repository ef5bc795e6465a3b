#pragma once

// A file that is written under a temporary name and renamed only when it is complete and on disk.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

class StagedFile {
 public:
  /// Creates `staging` and reserves `size` bytes, so that a full disk is detected before any bytes
  /// arrive.
  static absl::StatusOr<StagedFile> create(const std::string& staging, std::uint64_t size);
  /// Does the same as create(), but keeps the first `offset` bytes of an existing file and appends
  /// after them. OUT_OF_RANGE: the file is shorter, or there is none and `offset` is not 0; nothing
  /// is changed.
  static absl::StatusOr<StagedFile> resume(const std::string& staging, std::uint64_t size,
                                           std::uint64_t offset);
  StagedFile(StagedFile&&) noexcept;
  StagedFile& operator=(StagedFile&&) = delete;
  /// Removes the file unless commit() or leave() was called.
  ~StagedFile();

  /// RESOURCE_EXHAUSTED: the disk is full.
  absl::Status append(absl::Span<const std::byte> bytes) { return file_.write(bytes); }
  absl::Status read(std::uint64_t offset, absl::Span<std::byte> bytes) const {
    return file_.read(offset, bytes);
  }
  absl::Status sync() { return file_.sync(); }
  /// Keeps the first `size` bytes under the temporary name and frees the space reserved beyond
  /// them.
  void leave(std::uint64_t size);
  /// Gives the file its final name `target` in `folder`, durably: fsync, rename, fsync of `folder`.
  /// OK: the file is on disk under this name.
  absl::Status commit(const std::string& folder, const std::string& target);

 private:
  explicit StagedFile(File file) : file_(std::move(file)) {}
  File file_;
  bool staged_ = true;  ///< the destructor removes the file
};

}  // namespace bandsaw::coordinator
