#include "renderlib/import/scene_file/read_groups.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/copies.h"
#include "renderlib/import/scene_file/read_materials.h"
#include "renderlib/import/scene_file/read_models.h"
#include "renderlib/import/scene_file/read_placement.h"
#include "renderlib/import/scene_file/read_shapes.h"
#include "renderlib/import/scene_file/suggest.h"

namespace bandsaw {
namespace {

/// While it lives, what is read goes into a group.
class InGroup {
 public:
  InGroup(SceneDraft& draft, Shapes& shapes, Contents& placed)
      : draft_(draft),
        shapes_(std::exchange(draft.shapes, &shapes)),
        placed_(std::exchange(draft.placed, &placed)) {}
  InGroup(const InGroup&) = delete;
  InGroup& operator=(const InGroup&) = delete;
  ~InGroup() {
    draft_.shapes = shapes_;
    draft_.placed = placed_;
  }

 private:
  SceneDraft& draft_;
  Shapes* shapes_;
  Contents* placed_;
};

absl::StatusOr<Contents> read_group(const Field& in, const scene::Group& from, SceneDraft& draft) {
  Shapes shapes;
  Contents placed;
  const std::size_t cameras = draft.cameras.size();
  {
    const InGroup in_group(draft, shapes, placed);
    RETURN_IF_ERROR(read_shapes(in, from.shape(), draft));
    RETURN_IF_ERROR(read_models(in, from.model(), draft));
    RETURN_IF_ERROR(read_instances(in, from.instance(), draft));
  }
  draft.cameras.resize(cameras);  // A camera in a group is nowhere.
  if (shapes.size() > 0) {
    Geometry& geometry = draft.out.scene.geometry;
    geometry.groups.push_back(std::move(shapes));
    Instance loose;
    loose.group = GroupId{static_cast<std::uint32_t>(geometry.groups.size() - 1)};
    loose.material = kOwnMaterial;
    placed.seen.instances.insert(placed.seen.instances.begin(), loose);
  }
  if (placed.size() == 0) {
    return in.error("is empty: write shapes, models or instances in it");
  }
  return placed;
}

absl::StatusOr<const Contents*> find_group(const Field& in, const std::string& name,
                                           const SceneDraft& draft) {
  if (name.empty()) {
    return in.error("of", "is required: the name of a group");
  }
  const auto found = draft.groups.find(name);
  if (found != draft.groups.end()) {
    return &found->second;
  }
  std::vector<std::string> names;
  for (const auto& [known, group] : draft.groups) {
    names.push_back(known);
  }
  return in.error("of", absl::StrCat("no group is called \"", name, "\"", did_you_mean(name, names),
                                     "; within a group only earlier ones are known"));
}

/// Adds `what` where the placement, or the keys, say, moved by `copy`. False: as `place`.
bool place_copy(const Placements& what, const Transform& placement, const Transform& copy,
                const std::vector<Key>& keys, std::optional<MaterialId> material, Placements& to) {
  if (what.instances.empty()) {
    return true;
  }
  const Place at = keys.empty() ? Place{copy * placement, kNoFrame}
                                : Place{Transform{}, add_frame({kNoFrame, copy, keys}, to)};
  return place(what, at, material, to);
}

absl::Status read_instance(const Field& in, const scene::Instance& from, SceneDraft& draft) {
  ASSIGN_OR_RETURN(const Contents* group, find_group(in, from.of(), draft));
  std::optional<MaterialId> material;
  if (!from.material().empty()) {
    ASSIGN_OR_RETURN(material, find_material(in, from.material(), draft));
  }
  ASSIGN_OR_RETURN(const Transform placement, read_placement(in, from));
  ASSIGN_OR_RETURN(const std::vector<Key> keys, read_keys(in, from));
  ASSIGN_OR_RETURN(const std::vector<Transform> copies, read_copies(in, from));
  Contents& to = *draft.placed;
  if (to.size() + copies.size() * group->size() > kMaxPlacements) {
    return in.error(
        "of", absl::StrCat("makes more than ", kMaxPlacements, " placements of meshes and groups"));
  }
  for (const Transform& copy : copies) {
    // What a medium is inside of has no material to be replaced.
    if (!place_copy(group->seen, placement, copy, keys, material, to.seen) ||
        !place_copy(group->filled, placement, copy, keys, std::nullopt, to.filled)) {
      return in.error("scale", "is too large or too small for what is placed");
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status read_groups(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  for (int i = 0; i < from.group_size(); ++i) {
    const Field in = root.child("group", i);
    const scene::Group& group = from.group(i);
    if (group.name().empty()) {
      return in.error("name", "is required: instances name the group by it");
    }
    if (draft.groups.count(group.name()) > 0) {
      return in.error("name", absl::StrCat("\"", group.name(), "\" is taken by an earlier group"));
    }
    ASSIGN_OR_RETURN(Contents placed, read_group(in, group, draft));
    draft.groups.emplace(group.name(), std::move(placed));
  }
  return absl::OkStatus();
}

absl::Status read_instances(const Field& parent, const InstanceList& instances, SceneDraft& draft) {
  for (int i = 0; i < instances.size(); ++i) {
    RETURN_IF_ERROR(read_instance(parent.child("instance", i), instances[i], draft));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
