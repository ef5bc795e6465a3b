#pragma once

// A file that grows under another name and takes its own only when it is whole and on disk.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/base/file.h"

namespace bandsaw::coordinator {

class StagedFile {
 public:
  /// Makes `staging` and reserves `size` bytes for it, so that a full disk is known before the
  /// bytes come.
  static absl::StatusOr<StagedFile> create(const std::string& staging, std::uint64_t size);
  /// Likewise, but keeps the first `offset` bytes of what is there and goes on behind them.
  /// OUT_OF_RANGE: there are fewer.
  static absl::StatusOr<StagedFile> resume(const std::string& staging, std::uint64_t size,
                                           std::uint64_t offset);
  StagedFile(StagedFile&&) noexcept;
  StagedFile& operator=(StagedFile&&) = delete;
  /// Without commit or leave the file is removed.
  ~StagedFile();

  absl::Status append(absl::Span<const std::byte> bytes) { return file_.write(bytes); }
  absl::Status read(std::uint64_t offset, absl::Span<std::byte> bytes) const {
    return file_.read(offset, bytes);
  }
  absl::Status sync() { return file_.sync(); }
  /// Leaves its `size` bytes under the other name, without what was reserved beyond.
  void leave(std::uint64_t size);
  /// fsync, rename to `target` (in `folder`), fsync of `folder`. OK: on disk under its name.
  absl::Status commit(const std::string& folder, const std::string& target);

 private:
  explicit StagedFile(File file) : file_(std::move(file)) {}
  File file_;
  bool staged_ = true;
};

}  // namespace bandsaw::coordinator
