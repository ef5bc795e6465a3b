// Reads the entries `model` of a scene file. Each model file is read once. An entry places the
// meshes of its file, by a matrix or by keys (placements at given times), and adds the file's
// lights, its cameras, and the media inside of its meshes.

#include "renderlib/import/scene_file/read_models.h"

#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/named_file.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/scene_file/read_materials.h"
#include "renderlib/import/scene_file/read_media.h"
#include "renderlib/import/scene_file/read_placement.h"
#include "renderlib/import/scene_file/use_camera.h"

namespace bandsaw {
namespace {

/// Returns the animation that the entry names, or else the animation that was chosen for the
/// import.
AnimationChoice animation_of(const scene::Model& from, const SceneDraft& draft) {
  return from.animation().empty() ? draft.animation : AnimationChoice{from.animation()};
}

// Reads a model's file. Errors are at the field that names the file.
absl::StatusOr<std::shared_ptr<const Model>> read_file(const Field& in, const scene::Model& from,
                                                       SceneDraft& draft) {
  if (from.file().empty()) {
    return in.error("file", "is required: the name of a model file");
  }
  const auto file = find_named_file(from.file(), draft);
  if (!file.ok()) {
    return in.error("file", file.status().message());
  }
  if (!is_model_file(from.file())) {
    return in.error("file", absl::StrCat("\"", from.file(),
                                         "\" is not a model that is read: .gltf, .glb, .obj, "
                                         ".fbx, .dae, .3ds, .ply, .stl …"));
  }
  const bool with_materials = from.material().empty();
  auto model = file->made != nullptr
                   ? read_made_model(from.file(), *file->made, with_materials, draft)
                   : read_model(file->key, with_materials, draft, animation_of(from, draft));
  if (!model.ok()) {
    return in.error("file", model.status().message());
  }
  return std::make_shared<const Model>(*std::move(model));
}

/// Returns the model of an entry. Reads its file once, even if several entries name the file.
absl::StatusOr<std::shared_ptr<const Model>> find_file(const Field& in, const scene::Model& from,
                                                       SceneDraft& draft) {
  std::shared_ptr<const Model>& model =
      draft.models[{from.file(), !from.material().empty(), animation_of(from, draft)}];
  if (model == nullptr) {
    ASSIGN_OR_RETURN(model, read_file(in, from, draft));
  }
  return model;
}

/// Adds the delta lights of a model. They do not move: for a moving model, `to_world` is the
/// model's placement when the shutter opens. The lights of a model in a group are left out, with a
/// warning.
void add_lights(const std::string& file, const Model& model, const Transform& to_world,
                SceneDraft& draft) {
  if (draft.placed != &draft.world) {
    if (!model.lights.empty()) {
      draft.out.info.warnings.push_back(absl::StrCat(
          file, ": ", model.lights.size(), " lights are left out: a group cannot have lights"));
    }
    return;
  }
  for (const DeltaLight& light : model.lights) {
    draft.out.scene.lights.push_back(placed(light, to_world));
  }
}

/// Adds `what` to `to`, placed by `placement` or, if there are keys, moving according to `keys`. If
/// `material` is set, it replaces the materials of all instances.
absl::Status place_model(const Field& in, const Placements& what, const Transform& placement,
                         const std::vector<Key>& keys, std::optional<MaterialId> material,
                         Placements& to) {
  const Place at = keys.empty() ? Place{placement, kNoFrame}
                                : Place{Transform{}, add_frame({kNoFrame, {}, keys}, to)};
  return place(what, at, material, to)
             ? absl::OkStatus()
             : in.error("scale", "is too large or too small for this model");
}

/// Returns the boundaries of the medium that fills a model's meshes, one for each placed mesh. The
/// grids of a medium are in the space of the model, and a frame has one motion for a boundary and
/// its grids. So INVALID_ARGUMENT is returned if the medium has grids and a node of the model moves
/// while the shutter is open.
absl::StatusOr<Placements> read_interior(const Field& in, const scene::Model& from,
                                         const Model& model, SceneDraft& draft) {
  ASSIGN_OR_RETURN(const MediumId medium, find_medium(in, "interior", from.interior(), draft));
  Placements filled{model.frames, {}};
  const bool has_grids = draft.out.scene.media.media[index_of(medium)].grids.any();
  for (const Instance& mesh : model.instances) {
    if (has_grids && mesh.frame != kNoFrame) {
      return in.error(
          "interior",
          "has grids, but a node of the model moves while the shutter is open; move the "
          "whole model by keys, or use a medium without grids");
    }
    ASSIGN_OR_RETURN(Instance boundary, boundary_of(in, mesh, medium, draft));
    place_boundary({}, boundary, draft, filled);
    filled.instances.push_back(boundary);
  }
  return filled;
}

absl::Status read_model_entry(const Field& in, const scene::Model& from, SceneDraft& draft) {
  std::optional<MaterialId> material;
  if (!from.material().empty()) {
    ASSIGN_OR_RETURN(material, find_material(in, from.material(), draft));
  }
  ASSIGN_OR_RETURN(const Transform placement, read_placement(in, from));
  ASSIGN_OR_RETURN(const std::vector<Key> keys, read_keys(in, from));
  ASSIGN_OR_RETURN(const std::shared_ptr<const Model> model, find_file(in, from, draft));
  if (!from.interior().empty()) {
    ASSIGN_OR_RETURN(const Placements filled, read_interior(in, from, *model, draft));
    RETURN_IF_ERROR(place_model(in, filled, placement, keys, std::nullopt, draft.placed->filled));
  }
  if (from.boundary_only()) {
    return from.interior().empty()
               ? in.error("boundary_only",
                          "needs an interior: without it, nothing would be left of the model")
               : absl::OkStatus();
  }
  if (from.interior().empty() && !model->filled.empty()) {
    RETURN_IF_ERROR(place_model(in, {model->frames, model->filled}, placement, keys, std::nullopt,
                                draft.placed->filled));
  }
  RETURN_IF_ERROR(place_model(in, {model->frames, model->instances}, placement, keys, material,
                              draft.placed->seen));
  const auto placement_at = [&](double time) {
    return keys.empty() ? placement : motion_at({kNoFrame, {}, keys}, time);
  };
  const Transform at_open = placement_at(draft.shutter.open);
  add_lights(from.file(), *model, at_open, draft);
  add_cameras(from.file(), *model, at_open, placement_at(draft.shutter.close), draft);
  return absl::OkStatus();
}

}  // namespace

absl::Status read_models(const Field& parent, const ModelList& models, SceneDraft& draft) {
  for (int i = 0; i < models.size(); ++i) {
    RETURN_IF_ERROR(read_model_entry(parent.child("model", i), models[i], draft));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
