#pragma once

#include <memory>
#include <string>
#include <utility>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// A temporary folder that the destructor removes with its contents.
class ScratchFolder {
 public:
  /// Makes a new folder named `bandsaw-<use>-…` in `parent` or, if that is empty, in the system's
  /// folder for temporary files. Only this user may enter it. Errors as errno_status()
  /// (renderlib/base/file.h).
  static absl::StatusOr<std::unique_ptr<const ScratchFolder>> make(const std::string& use,
                                                                   const std::string& parent = "");
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}

  std::string path_;
};

}  // namespace bandsaw::coordinator
