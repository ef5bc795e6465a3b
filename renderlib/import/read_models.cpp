#include "renderlib/import/read_models.h"

#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/numbers.h"
#include "renderlib/import/read_materials.h"

namespace bandsaw {
namespace {

absl::StatusOr<Vec3> read_scale(const Field& in, const scene::Model& from) {
  const Numbers& list = from.scale();
  if (list.empty()) {
    return Vec3{1, 1, 1};
  }
  if (list.size() != 1 && list.size() != 3) {
    return in.error("scale", absl::StrCat("must be 1 or 3 numbers, has ", list.size()));
  }
  for (int i = 0; i < list.size(); ++i) {
    if (!std::isfinite(list[i]) || list[i] == 0) {
      return in.error("scale", absl::StrCat("must be finite and not zero, is ", list[i]), i);
    }
  }
  return list.size() == 1 ? Vec3{list[0], list[0], list[0]} : Vec3{list[0], list[1], list[2]};
}

absl::StatusOr<Transform> read_placement(const Field& in, const scene::Model& from) {
  ASSIGN_OR_RETURN(const Vec3 by, read_scale(in, from));
  Transform placement = scaling(by);
  for (int i = 0; i < from.rotate_size(); ++i) {
    const Field rotate = in.child("rotate", i);
    ASSIGN_OR_RETURN(const Vec3 axis, read_direction(rotate, "axis", from.rotate(i).axis()));
    const double degrees = from.rotate(i).degrees();
    if (!std::isfinite(degrees)) {
      return rotate.error("degrees", absl::StrCat("must be finite, is ", degrees));
    }
    placement = rotation(axis, degrees) * placement;
  }
  ASSIGN_OR_RETURN(const Vec3 to, read_vec3(in, "translate", from.translate(), Vec3{}));
  placement = translation(to) * placement;
  if (!inverse(placement)) {
    return in.error("scale", "flattens the model: its largest and smallest scale differ too much");
  }
  return placement;
}

PerspectiveCamera placed(const PerspectiveCamera& camera, const Transform& placement) {
  PerspectiveCamera out = camera;
  out.position = placement.point(camera.position);
  out.look_at = placement.point(camera.look_at);
  out.up = placement.direction(camera.up);
  return out;
}

// What may be wrong with a model's file, at the field that names it.
absl::StatusOr<Model> read_file(const Field& in, const scene::Model& from, SceneDraft& draft) {
  if (from.file().empty()) {
    return in.error("file", "is required: the name of a model file");
  }
  const auto path = draft.folder.resolve(from.file(), draft.folder.path());
  if (!path.ok()) {
    return in.error("file", path.status().message());
  }
  if (!is_model_file(*path)) {
    return in.error("file", absl::StrCat("\"", from.file(),
                                         "\" is not a model that is read: .gltf, .glb, .obj, "
                                         ".fbx, .dae, .3ds, .ply, .stl …"));
  }
  auto model = read_model(*path, from.material().empty(), draft);
  if (!model.ok()) {
    return in.error("file", model.status().message());
  }
  return model;
}

}  // namespace

absl::StatusOr<std::optional<PerspectiveCamera>> read_models(const Field& root,
                                                             const scene::Scene& from,
                                                             SceneDraft& draft) {
  std::map<std::pair<std::string, bool>, Model> read;
  std::optional<PerspectiveCamera> camera;
  for (int i = 0; i < from.model_size(); ++i) {
    const Field in = root.child("model", i);
    const scene::Model& entry = from.model(i);
    std::optional<MaterialId> material;
    if (!entry.material().empty()) {
      ASSIGN_OR_RETURN(material, find_material(in, entry.material(), draft));
    }
    ASSIGN_OR_RETURN(const Transform placement, read_placement(in, entry));
    const std::pair key(entry.file(), material.has_value());
    if (read.find(key) == read.end()) {
      ASSIGN_OR_RETURN(Model model, read_file(in, entry, draft));
      read.emplace(key, std::move(model));
    }
    const Model& model = read.at(key);
    for (const Instance& instance : model.instances) {
      const Transform to_world = placement * instance.to_world;
      if (!inverse(to_world)) {
        return in.error("scale", "is too large or too small for this model");
      }
      draft.out.scene.geometry.instances.push_back(
          {instance.mesh, material.value_or(instance.material), to_world});
    }
    if (model.camera && !camera) {
      camera = placed(*model.camera, placement);
    }
  }
  return camera;
}

}  // namespace bandsaw
