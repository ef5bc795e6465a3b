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
  StagedFile(StagedFile&&) noexcept;
  StagedFile& operator=(StagedFile&&) = delete;
  /// Without commit the file is removed.
  ~StagedFile();

  absl::Status append(absl::Span<const std::byte> bytes) { return file_.write(bytes); }
  absl::Status sync() { return file_.sync(); }
  /// fsync, rename to `target` (in `folder`), fsync of `folder`. OK: on disk under its name.
  absl::Status commit(const std::string& folder, const std::string& target);

 private:
  explicit StagedFile(File file) : file_(std::move(file)) {}
  File file_;
  bool staged_ = true;
};

}  // namespace bandsaw::coordinator
