// Reads the media of a scene file: the coefficients of each. Also makes the boundaries, which are
// the closed shapes that a medium fills, for the readers of shapes and models.

#include "renderlib/import/scene_file/read_media.h"

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/closed.h"
#include "renderlib/import/draft/boundaries.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_volumes.h"
#include "renderlib/import/scene_file/suggest.h"

namespace bandsaw {
namespace {

/// Reads a coefficient, which is per scene unit, and multiplies it by `density`. Returns 0 if the
/// field is not `given`.
absl::StatusOr<Rgb> read_rates(const Field& in, const std::string& name, bool given,
                               const scene::Color& color, double density) {
  if (!given) {
    return Rgb{};
  }
  ASSIGN_OR_RETURN(const Rgb rates, read_color(in.child(name), color, kMaxPerUnit));
  const Rgb scaled = rates * static_cast<float>(density);
  if (!(max_component(scaled) <= kMaxPerUnit)) {
    return in.error(name, absl::StrCat("must be at most ", kMaxPerUnit, " per scene unit, is ",
                                       max_component(scaled)));
  }
  return scaled;
}

/// Reads the coefficients and the grids of a medium. The field `density` is a factor of all
/// coefficients.
absl::StatusOr<Medium> read_medium(const Field& in, const scene::Medium& from, SceneDraft& draft) {
  if (from.has_albedo() && (from.has_absorption() || from.has_scattering())) {
    return in.error("albedo", "write albedo, or absorption and scattering, not both");
  }
  const double density = from.has_density() ? from.density() : 1;
  RETURN_IF_ERROR(check_range(in, "density", density, 0, 1e12));
  RETURN_IF_ERROR(check_range(in, "anisotropy", from.anisotropy(), -kMaxG, kMaxG));
  Medium medium;
  medium.g = from.anisotropy();
  ASSIGN_OR_RETURN(medium.absorption,
                   read_rates(in, "absorption", from.has_absorption(), from.absorption(), density));
  ASSIGN_OR_RETURN(medium.scattering,
                   read_rates(in, "scattering", from.has_scattering(), from.scattering(), density));
  ASSIGN_OR_RETURN(medium.emission,
                   read_rates(in, "emission", from.has_emission(), from.emission(), density));
  ASSIGN_OR_RETURN(medium.grids, read_grids(in, from, draft));
  if (!from.has_emission() && (medium.grids.emission || medium.grids.temperature)) {
    medium.emission = gray(static_cast<float>(density));
  }
  if (medium.grids.albedo) {
    medium.scattering = gray(static_cast<float>(density));
  }
  // With an albedo, the density is the extinction, and the albedo is the share that is scattered.
  if (from.has_albedo()) {
    ASSIGN_OR_RETURN(const Rgb albedo,
                     read_color(in.child("albedo"), from.albedo(), kMaxReflectance));
    const auto scale = static_cast<float>(density);
    medium.scattering = albedo * scale;
    medium.absorption = Rgb{1 - albedo.r, 1 - albedo.g, 1 - albedo.b} * scale;
  }
  return medium;
}

}  // namespace

absl::Status read_media(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  Media& media = draft.out.scene.media;
  for (int i = 0; i < from.medium_size(); ++i) {
    const Field in = root.child("medium", i);
    const std::string& name = from.medium(i).name();
    if (name.empty()) {
      return in.error("name", "is required, so that a shape can say what is inside of it");
    }
    ASSIGN_OR_RETURN(const Medium medium, read_medium(in, from.medium(i), draft));
    const MediumId id{static_cast<std::uint32_t>(media.media.size())};
    if (!draft.media.emplace(name, id).second) {
      return in.error("name", absl::StrCat("\"", name, "\" is the name of another medium"));
    }
    media.media.push_back(medium);
  }
  if (!from.fog().empty()) {
    ASSIGN_OR_RETURN(media.fog, find_medium(root, "fog", from.fog(), draft));
    if (media.media[index_of(*media.fog)].grids.any()) {
      return root.error("fog", "must not have grids: fill a shape with the medium");
    }
    if (is_endless_glow(media.media[index_of(*media.fog)])) {
      return root.error("fog",
                        "must absorb or scatter where it emits: it has no end, and would be "
                        "infinitely bright");
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<MediumId> find_medium(const Field& in, const std::string& field,
                                     const std::string& name, const SceneDraft& draft) {
  const auto found = draft.media.find(name);
  if (found != draft.media.end()) {
    return found->second;
  }
  std::vector<std::string> known;
  for (const auto& [other, id] : draft.media) {
    known.push_back(other);
  }
  return in.error(field,
                  absl::StrCat("no medium is called \"", name, "\"",
                               known.empty() ? "; the scene has none" : did_you_mean(name, known)));
}

Instance boundary_of(const Sphere& sphere, MediumId inside, SceneDraft& draft) {
  std::vector<Shapes>& groups = draft.out.scene.media.boundaries.groups;
  if (groups.empty()) {
    groups.push_back(unit_ball());
  }
  Instance instance;
  instance.group = GroupId{0};
  instance.material = filled_with(inside);
  const double r = sphere.radius;
  instance.to_world = translation(sphere.center) * scaling({r, r, r});
  return instance;
}

Instance boundary_of(const Vec3& low, const Vec3& high, MediumId inside, SceneDraft& draft) {
  Geometry& boundaries = draft.out.scene.media.boundaries;
  constexpr MeshId kCube{0xffffffffu};  // an id that no mesh of the scene has
  const auto [known, is_new] = draft.boundary_meshes.try_emplace(
      kCube, MeshId{static_cast<std::uint32_t>(boundaries.meshes.size())});
  if (is_new) {
    boundaries.meshes.push_back(unit_cube());
  }
  return {known->second, filled_with(inside), translation(low) * scaling(high - low)};
}

absl::StatusOr<Instance> boundary_of(const Field& in, const Instance& placed, MediumId inside,
                                     SceneDraft& draft) {
  if (const auto boundary = mesh_boundary(placed, inside, draft)) {
    return *boundary;
  }
  const Mesh& mesh = draft.out.scene.geometry.meshes[index_of(placed.mesh)];
  return in.error("interior", absl::StrCat("needs closed meshes; a mesh of ", mesh.triangles.size(),
                                           " triangles has ", open_edges(mesh),
                                           " open edges: close its holes, or use a "
                                           "box or a sphere"));
}

void place_boundary(const Transform& placement, Instance& boundary, const SceneDraft& draft,
                    Placements& to) {
  const MediumId inside = medium_in(boundary.material);
  const bool varies = draft.out.scene.media.media[index_of(inside)].grids.any();
  if (!varies && placement == Transform{}) {
    return;
  }
  if (!varies) {
    boundary.to_world = placement * boundary.to_world;
    return;
  }
  Frame frame;
  frame.placement = placement;
  frame.keys.emplace_back(0, Transform{});
  boundary.frame = add_frame(std::move(frame), to);
}

}  // namespace bandsaw
