#pragma once

// The scene while it is being read: each reader of a part of a scene file or of a model adds to it.

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "renderlib/import/animation/animation.h"
#include "renderlib/import/draft/import_memory.h"
#include "renderlib/import/draft/imported_scene.h"
#include "renderlib/import/draft/placements.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/image/texture_store.h"

namespace bandsaw {

struct Model;

/// A camera of one of the scene's models, in world space.
struct FoundCamera {
  std::string model;     ///< file of the model
  std::string name;      ///< name of its node
  std::string own_name;  ///< name of the camera itself; may be empty
  Camera camera;         ///< the camera when the shutter opens
  /// The camera when the shutter closes; std::nullopt if the camera does not move.
  std::optional<Camera> at_close = std::nullopt;
};

struct SceneDraft {
  /// `memory_of_frames` is shared with the imports of the scene's other frames. It is nullptr if no
  /// other frames are imported.
  SceneDraft(SceneFolder in, std::string scene_file, ImportMemory* memory_of_frames = nullptr)
      : folder(std::move(in)), file(std::move(scene_file)), memory(memory_of_frames) {}
  SceneDraft(const SceneDraft&) = delete;
  SceneDraft& operator=(const SceneDraft&) = delete;

  SceneFolder folder;
  std::string file;  ///< name of the scene file in errors
  /// Files that the converter of a foreign scene (a scene of another renderer) made, keyed by name.
  /// They are found before files of the folder (named_file.h).
  std::shared_ptr<const std::map<std::string, std::string>> made_files =
      std::make_shared<const std::map<std::string, std::string>>();
  ImportMemory* const memory;  ///< may be nullptr
  ImportedScene out;           ///< the result, to which all parts are added
  TextureStore textures{out.scene.textures, out.info.warnings,
                        memory == nullptr ? nullptr : &memory->images};
  std::map<std::string, MaterialId> materials;      ///< keyed by name in the scene file
  std::map<std::string, TextureId> named_textures;  ///< keyed by name in the scene file
  std::map<std::string, Contents> groups;           ///< keyed by name in the scene file
  std::map<std::string, MediumId> media;            ///< keyed by name in the scene file
  /// Grids of media, keyed by their description in the scene file.
  std::map<std::string, GridId> volumes;
  /// Meshes of the boundaries of media (closed surfaces around a medium). The key is the mesh of
  /// the scene from which the boundary is made, or an id that no mesh of the scene has.
  std::map<MeshId, MeshId> boundary_meshes;
  /// Models that have been read, keyed by file, by whether the scene replaces their materials, and
  /// by animation.
  std::map<std::tuple<std::string, bool, AnimationChoice>, std::shared_ptr<const Model>> models;
  /// Cameras of the models. If a model is placed several times, its first placement counts.
  std::vector<FoundCamera> cameras;
  Shutter shutter;            ///< of the frame that is imported, in the scene's time
  AnimationChoice animation;  ///< for models whose animation the scene file does not name

  Contents world;
  /// Destination of the shapes and placements that are read: the scene, or a group while it is read
  /// (see InGroup in scene_file/read_groups.cpp).
  Shapes* shapes = &out.scene.geometry;
  Contents* placed = &world;

  MaterialId add_material(const Material& material) {
    out.scene.materials.push_back(material);
    return MaterialId{static_cast<std::uint32_t>(out.scene.materials.size() - 1)};
  }
};

}  // namespace bandsaw
