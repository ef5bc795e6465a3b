#pragma once

// Finds the images of a model, embedded or in files, and adds them as textures to the draft, the
// scene that is being read.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"

struct aiScene;

namespace bandsaw {

class ModelTextures {
 public:
  /// All arguments MUST outlive this object. `model_path` is a real path below the draft's folder.
  ModelTextures(const aiScene& scene, const std::string& model_path, SceneDraft& draft)
      : scene_(scene), path_(model_path), draft_(draft) {}

  /// Finds an image by its name in the model and adds it as a texture. The image is embedded, or it
  /// is a file. The name of a file may have backslashes, be percent-encoded or differ in case. If
  /// the name leads to no file in the scene's folder, the last part of the name is looked up in
  /// the model's folder. Returns NOT_FOUND, PERMISSION_DENIED or INVALID_ARGUMENT with the reason.
  absl::StatusOr<TextureId> find(const std::string& file, const TextureStore::Use& use) const;

  /// Returns OK if find() would find a file or an embedded image, otherwise its error.
  absl::Status locate(const std::string& file) const { return source_of(file).status(); }

  /// Returns the decoded image without adding a texture. Errors are those of find().
  absl::StatusOr<ImageTexture> decoded(const std::string& file) const;

  /// Returns true if the image has an alpha channel that is not 255 everywhere. Errors are those of
  /// find() and of decoding.
  absl::StatusOr<bool> is_see_through(const std::string& file) const;

 private:
  /// An image, in a file or embedded in the model.
  struct Source {
    std::string key;    ///< identifies the image; for a file, its path
    std::string name;   ///< name for messages
    int embedded = -1;  ///< Assimp's number; -1 for a file
    absl::StatusOr<std::string> bytes(const aiScene& scene) const;
  };
  /// Finds an image as find() does, but adds no texture.
  absl::StatusOr<Source> source_of(const std::string& file) const;

  const aiScene& scene_;
  const std::string& path_;
  SceneDraft& draft_;
};

}  // namespace bandsaw
