#pragma once

// A model while it is being read: what its parts share.

#include <string>

#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/gltf_extensions.h"
#include "renderlib/import/model/unsupported_features.h"

struct aiScene;

namespace bandsaw {

/// What kind of file it is, as far as that matters.
enum class ModelKind {
  kGltf,
  kObj,
  kPlain,  ///< ply, stl, off: geometry, at most with vertex colours
  kOther,
};

struct ModelFile {
  const aiScene& scene;
  const std::string& path;  ///< real
  ModelKind kind = ModelKind::kOther;
  GltfExtensions gltf;  ///< of kGltf
  SceneDraft& draft;
  UnsupportedFeatures unsupported = {};

  std::string name() const { return name_of(path); }
  void warn(const std::string& what) {
    draft.out.info.warnings.push_back(absl::StrCat(name(), ": ", what));
  }
};

}  // namespace bandsaw
