#pragma once

// The only folder that an import reads: that of the scene file, and what lies below it.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"

namespace bandsaw {

class SceneFolder {
 public:
  /// The folder in which `scene_path` really lies, symbolic links followed. NOT_FOUND,
  /// PERMISSION_DENIED: naming the file.
  static absl::StatusOr<SceneFolder> of(const std::string& scene_path);

  /// The real path of the regular file that `name` means in a file that lies in `folder` (absolute,
  /// below this one). The messages name `name` and what to do, not who referred to it.
  /// PERMISSION_DENIED: absolute, or outside of the scene's folder, be it by a symbolic link.
  /// NOT_FOUND: there is no such file.
  absl::StatusOr<std::string> resolve(const std::string& name, const std::string& folder) const;

  /// The same, where `name` lies in `folder` itself; letters of either case count as equal. Of
  /// several, the first in the order of their bytes.
  absl::StatusOr<std::string> resolve_any_case(const std::string& name,
                                               const std::string& folder) const;

  const std::string& path() const { return path_; }

 private:
  explicit SceneFolder(std::string path) : path_(std::move(path)) {}
  bool holds(const std::string& real_path) const;
  std::string path_;  ///< absolute, without links, without a slash at the end
};

/// The folder part of an absolute path.
std::string folder_of(const std::string& path);
/// The last part of a path.
std::string name_of(const std::string& path);

}  // namespace bandsaw
