#pragma once

// The scene while it is being imported.

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderlib/import/draft/imported_scene.h"
#include "renderlib/import/draft/placements.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/image/texture_store.h"

namespace bandsaw {

struct Model;

/// A camera that a model of the scene brings, in the world.
struct FoundCamera {
  std::string model;  ///< its file
  std::string name;   ///< of its node
  std::string own_name;
  Camera camera;
};

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
  std::map<std::string, Contents> groups;           ///< the same
  std::map<std::string, MediumId> media;            ///< the same
  /// By the meshes of the scene, those of the boundaries of media that are the same.
  std::map<MeshId, MeshId> boundary_meshes;
  /// Models that have been read, by file and whether with materials.
  std::map<std::pair<std::string, bool>, std::shared_ptr<const Model>> models;
  std::vector<FoundCamera> cameras;  ///< of a model placed many times, those of its first place
  Shutter shutter;

  Contents world;
  /// Where what is read goes: the scene, or the group that is being read.
  Shapes* shapes = &out.scene.geometry;
  Contents* placed = &world;

  MaterialId add_material(const Material& material) {
    out.scene.materials.push_back(material);
    return MaterialId{static_cast<std::uint32_t>(out.scene.materials.size() - 1)};
  }
};

}  // namespace bandsaw
