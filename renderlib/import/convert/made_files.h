#pragma once

// Collects and names the files (meshes and images) that the converter of a foreign scene makes. A
// foreign scene is a scene of another renderer.

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include "absl/strings/string_view.h"

namespace bandsaw {

class MadeFiles {
 public:
  /// `scene` is the name of the foreign scene: "kitchen.pbrt". The files are named
  /// "kitchen_files/mesh_1.ply" and so on, so that `bandsaw import` writes them to a folder of
  /// their own.
  explicit MadeFiles(const std::string& scene);

  /// Stores a file and returns its name, for a field of the scene. Equal bytes with the same suffix
  /// are stored once. `what` ("mesh") begins the name, `suffix` (".ply") ends it.
  std::string add(absl::string_view what, absl::string_view suffix, std::string bytes);

  /// Returns the bytes of a file by the name that add() returned; nullptr for other names.
  const std::string* find(const std::string& name) const;

  /// Returns all files, keyed by name, and leaves this object empty.
  std::map<std::string, std::string> take() { return std::move(files_); }

 private:
  std::string folder_;
  std::map<std::string, std::string> files_;
  std::multimap<std::size_t, std::string> names_by_hash_;
  std::map<std::string, int> counts_;  ///< number of files so far, keyed by `what` of add()
};

}  // namespace bandsaw
