// Finds the files that a scene names, but no files outside of its folder. A name is resolved to its
// real path, which must lie below the real path of the folder, so no symbolic link leads outside.

#include "renderlib/import/files/scene_folder.h"

#include <algorithm>
#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace fs = std::filesystem;

std::string folder_of(const std::string& path) { return fs::path(path).parent_path().string(); }

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

absl::StatusOr<SceneFolder> SceneFolder::of(const std::string& scene_path) {
  std::error_code error;
  const fs::path real = fs::canonical(scene_path, error);
  if (error) {
    return errno_status(error.value(), scene_path);
  }
  if (fs::is_directory(real, error)) {
    return absl::InvalidArgumentError(
        absl::StrCat(scene_path, " is a folder; name a scene file or a model"));
  }
  return SceneFolder(real.parent_path().string());
}

absl::StatusOr<SceneFolder> SceneFolder::around(const std::string& scene_path,
                                                const std::string& folder) {
  ASSIGN_OR_RETURN(const SceneFolder own, of(scene_path));
  std::error_code error;
  const fs::path real = fs::canonical(folder, error);
  if (error) {
    return errno_status(error.value(), folder);
  }
  SceneFolder wide(real.string());
  if (own.path() != wide.path() && !wide.holds(own.path())) {
    return absl::PermissionDeniedError(
        absl::StrCat(scene_path, " does not lie in the folder ", folder));
  }
  return wide;
}

bool SceneFolder::holds(const std::string& real_path) const {
  return path_ == "/" || absl::StartsWith(real_path, path_ + "/");
}

absl::StatusOr<std::string> SceneFolder::resolve(const std::string& name,
                                                 const std::string& folder) const {
  if (name.empty() || name.find('\0') != std::string::npos) {
    return absl::InvalidArgumentError("a file name must not be empty or hold a zero byte");
  }
  const fs::path requested(name);
  if (requested.is_absolute()) {
    return absl::PermissionDeniedError(absl::StrCat(
        "\"", name, "\" is an absolute path; files are named relative to the scene's folder"));
  }
  const auto outside = [&] {
    return absl::PermissionDeniedError(absl::StrCat("\"", name,
                                                    "\" lies outside of the scene's folder ", path_,
                                                    "; files are read only below it"));
  };
  const fs::path whole = (fs::path(folder) / requested).lexically_normal();
  if (!holds(whole.string())) {
    return outside();
  }
  std::error_code error;
  const fs::path real = fs::canonical(whole, error);
  if (error == std::errc::permission_denied) {
    return absl::PermissionDeniedError(
        absl::StrCat("\"", name, "\" cannot be read, because permission is denied"));
  }
  if (error) {
    return absl::NotFoundError(
        absl::StrCat("\"", name, "\" is missing (looked for ", whole.string(), ")"));
  }
  if (!holds(real.string())) {
    return outside();
  }
  if (!fs::is_regular_file(real, error)) {
    return absl::InvalidArgumentError(absl::StrCat("\"", name, "\" is not a file"));
  }
  if (found_ != nullptr) {
    found_->emplace(whole.lexically_relative(path_).string(), real.string());
  }
  return real.string();
}

absl::StatusOr<std::string> SceneFolder::resolve_any_case(const std::string& name,
                                                          const std::string& folder) const {
  auto exact = resolve(name, folder);
  if (exact.ok() || name.find('/') != std::string::npos) {
    return exact;
  }
  std::string found;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string other = at->path().filename().string();
    if (absl::EqualsIgnoreCase(other, name) && (found.empty() || other < found)) {
      found = other;
    }
  }
  return found.empty() ? std::move(exact) : resolve(found, folder);
}

}  // namespace bandsaw
