#pragma once

// Memory that the imports of one scene at several frames share, so that its models and image
// textures are read only once. A scene of another renderer (a foreign scene) is converted only
// once.

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "renderlib/import/animation/animation.h"
#include "renderlib/import/image/texture_store.h"
#include "renderlib/package/encoded_parts.h"

namespace bandsaw {

struct ConvertedScene;  // import/convert/converted_scene.h
struct LoadedModel;     // import/model/loaded_model.h

/// Results of earlier imports. An object MUST be used for one scene only. All imports that use the
/// object MUST have equal ImportChoices (import.h) except for the frame. The scene's files MUST NOT
/// change between these imports.
struct ImportMemory {
  /// Models, keyed by their real path and by the chosen animation.
  std::map<std::pair<std::string, AnimationChoice>, std::shared_ptr<LoadedModel>> models = {};
  TextureStore::Memory images = {};                      ///< decoded images
  std::shared_ptr<const ConvertedScene> converted = {};  ///< the scene, if it is a foreign one
  EncodedParts encoded = {};  ///< meshes and texels of the last frame, with their digests
};

}  // namespace bandsaw
