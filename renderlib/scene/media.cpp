#include "renderlib/scene/media.h"

#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/closed.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

absl::Status check_rates(const std::string& field, const Rgb& rates) {
  for (const float rate : {rates.r, rates.g, rates.b}) {
    if (!(rate >= 0 && rate <= kMaxPerUnit)) {
      return invalid(field, absl::StrCat("must be in [0, ", kMaxPerUnit, "], is ", rate));
    }
  }
  return absl::OkStatus();
}

absl::Status check_medium(const std::string& field, const Medium& medium) {
  RETURN_IF_ERROR(check_rates(field + ".absorption", medium.absorption));
  RETURN_IF_ERROR(check_rates(field + ".scattering", medium.scattering));
  RETURN_IF_ERROR(check_rates(field + ".emission", medium.emission));
  if (!(std::abs(medium.g) <= kMaxG)) {
    return invalid(field + ".g",
                   absl::StrCat("must be in [", -kMaxG, ", ", kMaxG, "], is ", medium.g));
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

absl::Status check_closed(const std::string& field, const Mesh& mesh) {
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

absl::Status check_boundaries(const Media& media) {
  const Geometry& boundaries = media.boundaries;
  RETURN_IF_ERROR(
      check_geometry("boundaries.", boundaries, media.media.size(), MeshVertices::kAny));
  if (boundaries.size() != boundaries.spheres.size()) {
    return invalid("boundaries", "must be spheres and meshes alone: other shapes are open");
  }
  for (std::size_t i = 0; i < boundaries.groups.size(); ++i) {
    const Shapes& group = boundaries.groups[i];
    if (group.size() != 1 || group.spheres.size() != 1) {
      return invalid(item("boundaries.groups", i), "must be one sphere");
    }
  }
  for (std::size_t i = 0; i < boundaries.meshes.size(); ++i) {
    RETURN_IF_ERROR(check_closed(item("boundaries.meshes", i), boundaries.meshes[i]));
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

Shapes unit_ball() {
  Shapes ball;
  ball.spheres.push_back({{0, 0, 0}, 1, {}});
  return ball;
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
