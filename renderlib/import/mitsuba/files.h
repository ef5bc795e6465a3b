#pragma once

// Finds the files that a Mitsuba scene names. The folders of the scene's <path> elements are
// searched, beginning with the last element, and then the folder that contains the scene. Only
// files below the import's folder (ForeignScene::folder) are found.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/convert/foreign_scene.h"

namespace bandsaw::mitsuba {

struct FoundFile {
  std::string name;  ///< relative to the import's folder, as Bandsaw scene files name the file
  std::string path;  ///< real path
};

class Files {
 public:
  /// `scene` MUST outlive this object.
  explicit Files(const ForeignScene& scene) : scene_(scene) {}

  /// Adds a folder to search. `name` is relative to the folder of the real path `referring`.
  /// Returns PERMISSION_DENIED if the folder is outside of the import's folder, and NOT_FOUND if it
  /// does not exist.
  absl::Status add_folder(const std::string& name, const std::string& referring);

  /// Finds a file. Returns NOT_FOUND if it is missing, PERMISSION_DENIED if `name` leads outside of
  /// the import's folder or the file may not be read, and INVALID_ARGUMENT if `name` does not name
  /// a regular file.
  absl::StatusOr<FoundFile> find(const std::string& name) const;
  /// Finds a file by FoundFile::name. The errors are those of find().
  absl::StatusOr<FoundFile> known(const std::string& name) const;
  /// Returns the bytes of a file. Returns RESOURCE_EXHAUSTED or INVALID_ARGUMENT if the file has
  /// more than `max_bytes` bytes.
  static absl::StatusOr<std::string> read(const FoundFile& file, std::uint64_t max_bytes);

 private:
  const ForeignScene& scene_;
  std::vector<std::string> folders_;
};

}  // namespace bandsaw::mitsuba
