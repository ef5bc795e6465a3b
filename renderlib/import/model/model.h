#pragma once

// Reads model files of every format that Assimp supports, as meshes, materials and placements of
// the scene. This serves for models that a scene file names and for a model that is rendered alone.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/camera/camera.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/import/animation/animation.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/light/delta_light.h"

namespace bandsaw {

struct ModelCamera {
  std::string name;      ///< name of its node
  std::string own_name;  ///< the camera's name; may be empty or shared with other cameras
  Camera camera;         ///< at the start of the shutter interval, in the model's own space
  std::optional<Camera> at_close = std::nullopt;  ///< at the end, if the camera moves
};

/// A model whose meshes, materials and textures have been added to the SceneDraft (the scene while
/// it is being read); its placements have not.
struct Model {
  std::vector<Frame> frames = {};        ///< moving coordinate systems: one for each moving node
  std::vector<Instance> instances = {};  ///< placed in the model's space, or in one of `frames`
  std::vector<Instance> filled = {};  ///< closed meshes with a medium inside, placed as `instances`
  std::vector<ModelCamera> cameras = {};  ///< in the order of the nodes
  std::vector<DeltaLight> lights = {};    ///< in the model's space
};

/// Returns the camera transformed by `placement`.
Camera placed(Camera camera, const Transform& placement);

/// Returns true if the suffix is that of a supported model format: .gltf, .glb, .obj, .fbx, .dae,
/// .3ds, .ply, .stl and all others of Assimp.
bool is_model_file(const std::string& path);

/// Reads a model. `path` is a real path below the draft's folder. Without `with_materials` no
/// texture is read, and the materials of the placements are unspecified. Each omitted or repaired
/// part adds a warning to the draft. Messages begin with the file's name. Returns INVALID_ARGUMENT
/// if the model is broken or has no triangles, NOT_FOUND if a file that it needs or the chosen
/// animation is missing, and PERMISSION_DENIED for a file outside of the scene's folder.
/// `animation` chooses one of the model's animations, which is evaluated over the draft's shutter
/// interval. Nodes move during the interval. Vertices of skins and morph targets have one position
/// at the beginning of the interval and one at its end. With an animation the model may have no
/// placements, because a scale of 0 hides a node.
absl::StatusOr<Model> read_model(const std::string& path, bool with_materials, SceneDraft& draft,
                                 const AnimationChoice& animation = {});

/// Reads a model that a converter made, from its bytes. `name` is a file name, as if the model were
/// in the scene's folder. The model may name files of this folder; it MUST NOT be glTF. In all
/// other respects, the function works as read_model() without a chosen animation.
absl::StatusOr<Model> read_made_model(const std::string& name, absl::string_view bytes,
                                      bool with_materials, SceneDraft& draft);

}  // namespace bandsaw
