#pragma once

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/scene_draft.h"

struct aiScene;

namespace bandsaw {

inline constexpr unsigned kNoUvSet = ~0u;

/// A material of a model in the draft, and which of a mesh's sets of uvs become the two that ours
/// have.
struct ModelMaterial {
  MaterialId id{};
  unsigned uv_set = 0;
  unsigned second_uv_set = kNoUvSet;
};

/// Base colour or Kd with its texture, as Diffuse; Emissive where the material shines by a plain
/// colour and has no texture. NOT_FOUND, PERMISSION_DENIED, INVALID_ARGUMENT: a texture, with the
/// model's and the material's name.
absl::StatusOr<ModelMaterial> read_model_material(const aiScene& scene, unsigned index,
                                                  const std::string& model_path, SceneDraft& draft);

}  // namespace bandsaw
