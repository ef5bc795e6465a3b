// Reads the groups and instances of a scene file. A group's shapes and models are read once into a
// Contents, which holds placements of meshes and groups (draft/placements.h). Each instance of the
// group copies these placements, transformed, into the scene or into another group.

#include "renderlib/import/scene_file/read_groups.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/split_mix.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/placements.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_materials.h"
#include "renderlib/import/scene_file/read_models.h"
#include "renderlib/import/scene_file/read_placement.h"
#include "renderlib/import/scene_file/read_shapes.h"
#include "renderlib/import/scene_file/suggest.h"
#include "renderlib/math/transform.h"

namespace bandsaw {
namespace {

/// Returns a number in [0, 1) that depends on seed, copy and use alone. `use` is the index of the
/// number among the random numbers of the copy.
double random_number(std::uint64_t seed, std::uint64_t copy, std::uint64_t use) {
  std::uint64_t x = seed;
  for (const std::uint64_t next : {copy, use}) {
    x = split_mix(x + kSplitMixIncrement * (next + 1));
  }
  return static_cast<double>(x >> 11) * 0x1p-53;
}

/// A regular grid of copies of a group, each of which is moved, turned and scaled at random.
struct Grid {
  std::uint64_t count[3];  ///< copies along x, y, z
  Vec3 step;               ///< from copy to copy
  Vec3 origin;             ///< place of the first copy
  Vec3 jitter;             ///< maximum of the random translation along each axis
  double turn = 0;         ///< maximum of the random rotation about y, in degrees
  double least = 1;        ///< the random scale is in [least, most]
  double most = 1;
  std::uint64_t seed = 0;
};

absl::StatusOr<Grid> read_grid(const Field& in, const scene::Grid& from) {
  Grid grid;
  if (from.count_size() != 3) {
    return in.error("count", absl::StrCat("must be 3 numbers, has ", from.count_size()));
  }
  std::uint64_t all = 1;
  for (int k = 0; k < 3; ++k) {
    if (from.count(k) < 1 || from.count(k) > kMaxPlacements) {
      return in.error("count", absl::StrCat("must be at least 1 and at most ", kMaxPlacements,
                                            ", is ", from.count(k)));
    }
    grid.count[k] = from.count(k);
    all *= grid.count[k];
    if (all > kMaxPlacements) {
      return in.error("count", absl::StrCat("makes more than ", kMaxPlacements, " copies"));
    }
  }
  ASSIGN_OR_RETURN(grid.step, read_vec3(in, "step", from.step()));
  ASSIGN_OR_RETURN(grid.origin, read_vec3(in, "origin", from.origin(), Vec3{}));
  ASSIGN_OR_RETURN(grid.jitter, read_vec3(in, "jitter", from.jitter(), Vec3{}));
  if (!(grid.jitter.x >= 0 && grid.jitter.y >= 0 && grid.jitter.z >= 0)) {
    return in.error("jitter", "must not be negative");
  }
  grid.turn = from.turn();
  RETURN_IF_ERROR(check_range(in, "turn", grid.turn, 0, 1e9));
  if (from.scale_size() != 0) {
    if (from.scale_size() != 2 ||
        !(from.scale(0) > 0 && from.scale(0) <= from.scale(1) && std::isfinite(from.scale(1)))) {
      return in.error("scale", "must be [least, most] with 0 < least <= most");
    }
    grid.least = from.scale(0);
    grid.most = from.scale(1);
  }
  grid.seed = from.seed();
  return grid;
}

/// Returns the transform of copy `number`; x varies fastest.
Transform copy_of(const Grid& grid, std::uint64_t number) {
  const std::uint64_t i = number % grid.count[0];
  const std::uint64_t j = number / grid.count[0] % grid.count[1];
  const std::uint64_t k = number / grid.count[0] / grid.count[1];
  const auto random = [&](std::uint64_t use) { return random_number(grid.seed, number, use); };
  const auto around = [&](std::uint64_t use, double by) { return by * (2 * random(use) - 1); };
  const double dx = around(0, grid.jitter.x);
  const double dy = around(1, grid.jitter.y);
  const double dz = around(2, grid.jitter.z);
  const Vec3 to = grid.origin + Vec3{static_cast<double>(i) * grid.step.x + dx,
                                     static_cast<double>(j) * grid.step.y + dy,
                                     static_cast<double>(k) * grid.step.z + dz};
  const double size = grid.least + (grid.most - grid.least) * random(4);
  return translation(to) * rotation({0, 1, 0}, grid.turn * random(3)) * scaling({size, size, size});
}

/// Reads the transforms of an instance's copies; at least one.
absl::StatusOr<std::vector<Transform>> read_copies(const Field& in, const scene::Instance& from) {
  std::vector<Transform> copies;
  if (from.has_grid()) {
    if (from.at_size() > 0) {
      return in.error("grid", "write grid or at, not both");
    }
    ASSIGN_OR_RETURN(const Grid grid, read_grid(in.child("grid"), from.grid()));
    const std::uint64_t count = grid.count[0] * grid.count[1] * grid.count[2];
    for (std::uint64_t i = 0; i < count; ++i) {
      copies.push_back(copy_of(grid, i));
    }
    return copies;
  }
  for (int i = 0; i < from.at_size(); ++i) {
    ASSIGN_OR_RETURN(const Transform copy, read_placement(in.child("at", i), from.at(i)));
    copies.push_back(copy);
  }
  if (copies.empty()) {
    copies.push_back(Transform{});
  }
  return copies;
}

/// While an object of this class exists, shapes and placements that are read are added to a group.
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

/// Reads a group. While its shapes, models and instances are read, they are added to the group and
/// not to the scene.
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
  draft.cameras.resize(cameras);  // cameras in groups are ignored
  if (shapes.size() > 0) {
    Geometry& geometry = draft.out.scene.geometry;
    geometry.groups.push_back(std::move(shapes));
    Instance loose;  // places the shapes that the group itself contains
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
                                     "; a group may only refer to groups before it"));
}

/// Adds `what` to `to`, placed by `placement` or, if there are keys, moving according to `keys`.
/// The transform `copy` is applied after the placement or the motion. Returns false if a placement
/// would be singular.
bool place_copy(const Placements& what, const Transform& placement, const Transform& copy,
                const std::vector<Key>& keys, std::optional<MaterialId> material, Placements& to) {
  if (what.instances.empty()) {
    return true;
  }
  const Place at = keys.empty() ? Place{copy * placement, kNoFrame}
                                : Place{Transform{}, add_frame({kNoFrame, copy, keys}, to)};
  return place(what, at, material, to);
}

/// Places the group that an instance names, once for each of the instance's copies.
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
    // `filled` holds the boundaries of media, which have no material that could be replaced.
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
