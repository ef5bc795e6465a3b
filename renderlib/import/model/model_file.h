#pragma once

// The state that the functions which convert one model share. read_source() in model.cpp makes it.

#include <optional>
#include <string>

#include "renderlib/import/animation/animation.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/model/collada_cameras.h"
#include "renderlib/import/model/gltf_extensions.h"
#include "renderlib/import/model/loaded_model.h"
#include "renderlib/import/model/mtl_options.h"
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

/// A model while it is converted and added to `draft`, the unfinished scene. All references
/// except `path` and `draft` refer to parts of one LoadedModel (model/loaded_model.h).
struct ModelFile {
  const aiScene& scene;
  const std::string& path;  ///< real path
  ModelKind kind = ModelKind::kOther;
  const GltfExtensions& gltf;                 ///< set for kGltf
  const MtlOptions& mtl;                      ///< set for kObj
  const ColladaLenses& lenses;                ///< set for COLLADA
  const std::optional<Animation>& animation;  ///< the chosen one; std::nullopt: rest pose
  StillMeshes& still_meshes;                  ///< converted meshes that no animation changes
  SceneDraft& draft;
  UnsupportedFeatures unsupported = {};

  std::string name() const { return name_of(path); }
  bool is_collada() const { return bandsaw::is_collada(path); }
  void warn(const std::string& what) {
    draft.out.info.warnings.push_back(absl::StrCat(name(), ": ", what));
  }
};

}  // namespace bandsaw
