#pragma once

// Assimp's view of the disk: the scene's folder, read only.

#include <assimp/IOSystem.hpp>

#include <string>
#include <vector>

#include "renderlib/import/files/scene_folder.h"

namespace bandsaw {

/// What a model referred to and did not get. Outlives the Assimp importer, which owns its
/// AssimpFiles.
struct RefusedFiles {
  std::vector<std::string> missing;  ///< names as the model writes them
  std::vector<std::string> outside;  ///< messages
};

class AssimpFiles : public Assimp::IOSystem {
 public:
  /// `model` is the real path of the model; other files are relative to its folder.
  AssimpFiles(const SceneFolder& folder, const std::string& model, RefusedFiles& refused)
      : folder_(folder), model_folder_(folder_of(model)), refused_(refused) {}

  bool Exists(const char* file) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

 private:
  absl::StatusOr<std::string> find(const std::string& file) const;
  const SceneFolder& folder_;
  std::string model_folder_;
  RefusedFiles& refused_;
};

}  // namespace bandsaw
