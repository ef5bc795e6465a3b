#pragma once

// SceneFolder is the only folder that an import reads, together with the folders below it. It is
// the folder of the scene file, or a folder above the scene file's folder, if the user named one.

#include <cstdint>
#include <map>
#include <string>

#include "absl/status/statusor.h"

namespace bandsaw {

class SceneFolder {
 public:
  /// Returns the folder of `scene_path`, with symbolic links resolved. The error is NOT_FOUND or
  /// PERMISSION_DENIED with the file's name, or INVALID_ARGUMENT if `scene_path` is a folder.
  static absl::StatusOr<SceneFolder> of(const std::string& scene_path);

  /// Returns the folder `folder`, below which `scene_path` must be. The errors are those of of().
  /// The error is also PERMISSION_DENIED if the scene does not lie below `folder`.
  static absl::StatusOr<SceneFolder> around(const std::string& scene_path,
                                            const std::string& folder);

  /// A file in `folder` refers to another file by `name`, a path relative to `folder`. Returns the
  /// real path of the other file. `folder` is absolute, and is this folder or lies below it.
  /// Messages contain `name`, unless it is empty or has a zero byte, but not the name of the file
  /// in `folder`. Returns INVALID_ARGUMENT if the name is empty, has a zero byte or is not that of
  /// a regular file. Returns PERMISSION_DENIED if the name is an absolute path, if it leads outside
  /// of the scene's folder, directly or through a symbolic link, or if the process may not access
  /// the file. Returns NOT_FOUND if there is no such file.
  absl::StatusOr<std::string> resolve(const std::string& name, const std::string& folder) const;

  /// Does the same as resolve(). But if resolve() fails and `name` has no slash, searches `folder`,
  /// without its subfolders, for a file whose name differs from `name` only in upper and lower
  /// case. If there are several such files, takes the first in byte order.
  absl::StatusOr<std::string> resolve_any_case(const std::string& name,
                                               const std::string& folder) const;

  const std::string& path() const { return path_; }

  /// After this call, resolve() adds each file that it finds to `files`, which maps the file's path
  /// relative to this folder to its real path. After a call with nullptr, files are no longer
  /// added. `files` MUST outlive the calls of resolve().
  void record_to(std::map<std::string, std::string>* files) { found_ = files; }

 private:
  explicit SceneFolder(std::string path) : path_(std::move(path)) {}
  /// Returns true if the path lies below this folder.
  bool holds(const std::string& real_path) const;
  std::string path_;  ///< absolute, without links, without a slash at the end
  std::map<std::string, std::string>* found_ = nullptr;  ///< set by record_to()
};

/// Returns the folder of an absolute path.
std::string folder_of(const std::string& path);
/// Returns the last part of a path.
std::string name_of(const std::string& path);

}  // namespace bandsaw
