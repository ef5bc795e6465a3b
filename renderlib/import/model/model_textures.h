#pragma once

// The images that a model refers to, embedded or beside it, as textures of the draft.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/scene_draft.h"

struct aiScene;

namespace bandsaw {

class ModelTextures {
 public:
  /// All outlive this. `model_path` is real and below the draft's folder.
  ModelTextures(const aiScene& scene, const std::string& model_path, SceneDraft& draft)
      : scene_(scene), path_(model_path), draft_(draft) {}

  /// `file` is a name as the model writes it: of an embedded image, or of a file as it stands, with
  /// backslashes, percent-encoded, in other case, or by a path of another machine, whose last part
  /// lies beside the model. NOT_FOUND, PERMISSION_DENIED, INVALID_ARGUMENT: the reason.
  absl::StatusOr<TextureId> find(const std::string& file, const TextureStore::Use& use) const;

  /// Whether find() would find a file, or the image within the model.
  absl::Status locate(const std::string& file) const { return source_of(file).status(); }

  /// Its texels alone, for a look at them. Errors: as find.
  absl::StatusOr<ImageTexture> decoded(const std::string& file) const;

  /// Whether the image has an alpha channel. Errors: as find.
  absl::StatusOr<bool> has_alpha(const std::string& file) const;

 private:
  struct Source {
    std::string key;    ///< tells images apart
    std::string name;   ///< for people
    int embedded = -1;  ///< Assimp's number, or -1: a file
    absl::StatusOr<std::string> bytes(const aiScene& scene) const;
  };
  absl::StatusOr<Source> source_of(const std::string& file) const;

  const aiScene& scene_;
  const std::string& path_;
  SceneDraft& draft_;
};

}  // namespace bandsaw
