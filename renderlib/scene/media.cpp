#include "renderlib/scene/media.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/closed.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {
namespace {

absl::Status invalid(const std::string& field, const std::string& why) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", why));
}

absl::Status check_rates(const std::string& field, const Rgb& rates) {
  for (const float rate : {rates.r, rates.g, rates.b}) {
    if (!(rate >= 0 && rate <= kMostPerUnit)) {
      return invalid(field, absl::StrCat("must be in [0, ", kMostPerUnit, "], is ", rate));
    }
  }
  return absl::OkStatus();
}

absl::Status check_medium(const std::string& field, const Medium& medium) {
  RETURN_IF_ERROR(check_rates(field + ".absorption", medium.absorption));
  RETURN_IF_ERROR(check_rates(field + ".scattering", medium.scattering));
  RETURN_IF_ERROR(check_rates(field + ".emission", medium.emission));
  if (!(std::abs(medium.g) <= kMostG)) {
    return invalid(field + ".g",
                   absl::StrCat("must be in [", -kMostG, ", ", kMostG, "], is ", medium.g));
  }
  return absl::OkStatus();
}

absl::Status check_fog(const Media& media) {
  if (index_of(*media.fog) >= media.media.size()) {
    return invalid(
        "fog", absl::StrCat("must be below ", media.media.size(), ", is ", index_of(*media.fog)));
  }
  if (is_endless_glow(media.media[index_of(*media.fog)])) {
    return invalid("fog",
                   "must absorb or scatter where it emits: it has no end, and would be "
                   "infinitely bright");
  }
  return absl::OkStatus();
}

absl::Status check_filling(const std::string& field, MaterialId medium, const Media& media) {
  if (index_of(medium) < media.media.size()) {
    return absl::OkStatus();
  }
  return invalid(field,
                 absl::StrCat("must be below ", media.media.size(), ", is ", index_of(medium)));
}

absl::Status check_mesh(const std::string& field, const Mesh& mesh) {
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner >= mesh.positions.size()) {
        return invalid(
            field + ".triangles",
            absl::StrCat("must be indices below ", mesh.positions.size(), ", one is ", corner));
      }
    }
  }
  for (const std::array<float, 3>& p : mesh.positions) {
    if (!is_finite(Vec3{p[0], p[1], p[2]})) {
      return invalid(field + ".positions", "must be finite");
    }
  }
  if (const std::size_t open = open_edges(mesh); open > 0) {
    return invalid(field, absl::StrCat("must be closed, has ", open, " open edges"));
  }
  return absl::OkStatus();
}

bool is_placed_sphere(const Sphere& sphere) {
  return is_finite(sphere.center) && max_abs(sphere.center) <= kMaxCoordinate &&
         sphere.radius > 0 && sphere.radius <= kMaxCoordinate;
}

absl::Status check_boundaries(const Media& media) {
  const Geometry& geometry = media.boundaries;
  if (geometry.size() != geometry.spheres.size()) {
    return invalid("boundaries", "must be spheres and meshes alone: other shapes are open");
  }
  if (!geometry.groups.empty() || !geometry.frames.empty()) {
    return invalid("boundaries", "must rest and lie in no group");
  }
  for (std::size_t i = 0; i < geometry.spheres.size(); ++i) {
    const std::string field = absl::StrCat("boundaries.spheres[", i, "]");
    if (!is_placed_sphere(geometry.spheres[i])) {
      return invalid(field,
                     absl::StrCat("must have a radius > 0 and lie within +-", kMaxCoordinate));
    }
    RETURN_IF_ERROR(check_filling(field + ".medium", geometry.spheres[i].material, media));
  }
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_mesh(absl::StrCat("boundaries.meshes[", i, "]"), geometry.meshes[i]));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const std::string field = absl::StrCat("boundaries.instances[", i, "]");
    const Instance& instance = geometry.instances[i];
    if (index_of(instance.mesh) >= geometry.meshes.size()) {
      return invalid(field + ".mesh", absl::StrCat("must be below ", geometry.meshes.size(),
                                                   ", is ", index_of(instance.mesh)));
    }
    RETURN_IF_ERROR(check_filling(field + ".medium", instance.material, media));
    if (instance.group != kNoGroup || instance.frame != kNoFrame) {
      return invalid(field, "must be a mesh that rests");
    }
    if (!inverse(instance.to_world)) {
      return invalid(field + ".to_world", "must be finite and have an inverse");
    }
  }
  return absl::OkStatus();
}

}  // namespace

Mesh unit_cube() {
  Mesh cube;
  for (int i = 0; i < 8; ++i) {
    cube.positions.push_back(
        {static_cast<float>(i & 1), static_cast<float>(i >> 1 & 1), static_cast<float>(i >> 2)});
  }
  cube.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return cube;
}

absl::Status validate(const Media& media) {
  for (std::size_t i = 0; i < media.media.size(); ++i) {
    RETURN_IF_ERROR(check_medium(absl::StrCat("media[", i, "]"), media.media[i]));
  }
  if (media.fog) {
    RETURN_IF_ERROR(check_fog(media));
  }
  return check_boundaries(media);
}

}  // namespace bandsaw
