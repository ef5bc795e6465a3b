// Finds the files that a Mitsuba scene names. find() searches the folders of the <path> elements,
// beginning with the last element, and then the folder that contains the scene. A file outside of
// the import's folder (ForeignScene::folder) is never found.

#include "renderlib/import/mitsuba/files.h"

#include <filesystem>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::mitsuba {
namespace fs = std::filesystem;

absl::Status Files::add_folder(const std::string& name, const std::string& referring) {
  const fs::path whole = (fs::path(folder_of(referring)) / name).lexically_normal();
  std::error_code error;
  const fs::path real = fs::canonical(whole, error);
  const std::string& top = scene_.folder.path();
  const auto inside = [&](const std::string& path) {
    return path == top || absl::StartsWith(path, top + "/");
  };
  // The path as written is checked too, so that a folder outside is refused whether it exists or
  // not. parent_path() of whole / "x" is `whole` without a slash at its end.
  if (!inside((whole / "x").parent_path().string()) || (!error && !inside(real.string()))) {
    return absl::PermissionDeniedError(
        absl::StrCat("folder \"", name, "\" lies outside of the scene's folder ", top,
                     "; files are read only below it: name a wider one with --folder"));
  }
  if (error || !fs::is_directory(real, error)) {
    return absl::NotFoundError(absl::StrCat("folder \"", name, "\" is missing"));
  }
  folders_.push_back(real.string());
  return absl::OkStatus();
}

absl::StatusOr<FoundFile> Files::find(const std::string& name) const {
  std::vector<std::string> folders = {folder_of(scene_.path)};
  folders.insert(folders.end(), folders_.begin(), folders_.end());
  absl::StatusOr<std::string> path;
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) {
    path = scene_.folder.resolve(name, *folder);
    if (path.ok()) {
      const fs::path whole = (fs::path(*folder) / name).lexically_normal();
      return FoundFile{whole.lexically_relative(scene_.folder.path()).string(), *path};
    }
  }
  return path.status();
}

absl::StatusOr<FoundFile> Files::known(const std::string& name) const {
  ASSIGN_OR_RETURN(std::string path, scene_.folder.resolve(name, scene_.folder.path()));
  return FoundFile{name, std::move(path)};
}

absl::StatusOr<std::string> Files::read(const FoundFile& file, std::uint64_t max_bytes) {
  return read_whole_file(file.path, max_bytes);
}

}  // namespace bandsaw::mitsuba
