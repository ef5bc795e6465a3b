#pragma once

// The scene while it is being imported.

#include <map>
#include <string>

#include "renderlib/import/import.h"
#include "renderlib/import/scene_folder.h"
#include "renderlib/import/texture_store.h"

namespace bandsaw {

struct SceneDraft {
  SceneDraft(SceneFolder in, std::string scene_file)
      : folder(std::move(in)), file(std::move(scene_file)) {}
  SceneDraft(const SceneDraft&) = delete;
  SceneDraft& operator=(const SceneDraft&) = delete;

  SceneFolder folder;
  std::string file;  ///< what errors call the scene file
  ImportedScene out;
  TextureStore textures{out.scene.textures, out.info.warnings};
  std::map<std::string, MaterialId> materials;      ///< by the names in the scene file
  std::map<std::string, TextureId> named_textures;  ///< the same

  MaterialId add_material(const Material& material) {
    out.scene.materials.push_back(material);
    return MaterialId{static_cast<std::uint32_t>(out.scene.materials.size() - 1)};
  }
};

}  // namespace bandsaw
