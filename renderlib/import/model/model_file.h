#pragma once

// State that the parts of the model reader share.

#include <optional>
#include <string>

#include "renderlib/import/animation/animation.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/gltf_extensions.h"
#include "renderlib/import/model/unsupported_features.h"

struct aiScene;

namespace bandsaw {

/// Kind of a model file, as far as it affects reading.
enum class ModelKind {
  kGltf,
  kObj,
  kPlain,  ///< ply, stl, off: geometry and possibly vertex colours
  kOther,
};

struct ModelFile {
  const aiScene& scene;
  const std::string& path;  ///< real path
  ModelKind kind = ModelKind::kOther;
  GltfExtensions gltf;  ///< set for kGltf
  SceneDraft& draft;
  UnsupportedFeatures unsupported = {};
  std::optional<Animation> animation = std::nullopt;  ///< the chosen one; none: the rest pose

  std::string name() const { return name_of(path); }
  void warn(const std::string& what) {
    draft.out.info.warnings.push_back(absl::StrCat(name(), ": ", what));
  }
};

}  // namespace bandsaw
