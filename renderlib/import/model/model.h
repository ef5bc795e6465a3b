#pragma once

// Model files, of every format that Assimp reads, as meshes, materials and placements of the scene.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/camera/camera.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/light/delta_light.h"

namespace bandsaw {

struct ModelCamera {
  std::string name;      ///< of its node
  std::string own_name;  ///< may be empty, and be that of other nodes' cameras too
  Camera camera;         ///< in the model's own space
};

/// A model in the draft: its meshes, materials and textures have been added there, its placements
/// have not.
struct Model {
  std::vector<Instance> instances = {};   ///< in the model's own space
  std::vector<Instance> filled = {};      ///< likewise, of Media::boundaries
  std::vector<ModelCamera> cameras = {};  ///< in the order of its nodes
  std::vector<DeltaLight> lights = {};
};

/// The same camera where `placement` puts it.
Camera placed(Camera camera, const Transform& placement);

/// Whether the suffix is that of a model that is read: .gltf, .glb, .obj, .fbx, .dae, .3ds, .ply,
/// .stl and whatever else Assimp knows.
bool is_model_file(const std::string& path);

/// `path` is real and below the draft's folder. Without `with_materials` no texture is read, and
/// the placements' materials mean nothing. What is left out or repaired is a warning of the draft.
/// Messages begin with the file's name: INVALID_ARGUMENT: broken, or without triangles. NOT_FOUND,
/// PERMISSION_DENIED: a file that it needs.
absl::StatusOr<Model> read_model(const std::string& path, bool with_materials, SceneDraft& draft);

}  // namespace bandsaw
