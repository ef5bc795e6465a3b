// Makes the unit shapes of boundaries (the closed shapes that media fill). Validates media, their
// boundaries, and the grids by which they vary in space.

#include "renderlib/scene/media.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/geometry/closed.h"
#include "renderlib/math/float3.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

/// Checks absorption, scattering or emission per unit of length.
absl::Status check_rates(const std::string& field, const Rgb& rates) {
  for (const float rate : {rates.r, rates.g, rates.b}) {
    if (!(rate >= 0 && rate <= kMaxPerUnit)) {
      return invalid(field, absl::StrCat("must be in [0, ", kMaxPerUnit, "], is ", rate));
    }
  }
  return absl::OkStatus();
}

/// Checks the use of a grid. `coefficient` is the medium's largest coefficient that is multiplied
/// by the numbers of the grid. `grid_maxima` holds the largest number of each grid.
absl::Status check_use(const std::string& field, const std::optional<GridUse>& use,
                       const std::vector<float>& grid_maxima, float coefficient) {
  if (!use) {
    return absl::OkStatus();
  }
  RETURN_IF_ERROR(check_index(field + ".grid", use->grid, grid_maxima.size()));
  if (!(use->scale >= 0 && std::isfinite(use->scale))) {
    return invalid(field + ".scale", absl::StrCat("must be finite and >= 0, is ", use->scale));
  }
  const double most = double{coefficient} * use->scale * grid_maxima[index_of(use->grid)];
  if (!(most <= kMaxPerUnit)) {
    return invalid(field,
                   absl::StrCat("must be at most ", kMaxPerUnit,
                                " per scene unit with the medium's coefficients, is ", most));
  }
  return absl::OkStatus();
}

/// Checks the grids of a medium. The numbers of a temperature grid are multiplied by its scale
/// alone, so their coefficient is 1. The numbers of an albedo grid have no maximum, so their
/// coefficient is 0.
absl::Status check_grids(const std::string& field, const Medium& medium,
                         const std::vector<float>& grid_maxima) {
  const float emission = max_component(medium.emission);
  const float coefficient =
      std::max({max_component(medium.absorption), max_component(medium.scattering), emission});
  const MediumGrids& grids = medium.grids;
  RETURN_IF_ERROR(check_use(field + ".density_grid", grids.density, grid_maxima, coefficient));
  RETURN_IF_ERROR(check_use(field + ".albedo_grid", grids.albedo, grid_maxima, 0));
  RETURN_IF_ERROR(check_use(field + ".emission_grid", grids.emission, grid_maxima, emission));
  RETURN_IF_ERROR(check_use(field + ".temperature_grid", grids.temperature, grid_maxima, 1));
  if (!std::isfinite(grids.temperature_offset)) {
    return invalid(field + ".temperature_offset", "must be finite");
  }
  return absl::OkStatus();
}

absl::Status check_medium(const std::string& field, const Medium& medium,
                          const std::vector<float>& grid_maxima) {
  RETURN_IF_ERROR(check_rates(field + ".absorption", medium.absorption));
  RETURN_IF_ERROR(check_rates(field + ".scattering", medium.scattering));
  RETURN_IF_ERROR(check_rates(field + ".emission", medium.emission));
  if (!(std::abs(medium.g) <= kMaxG)) {
    return invalid(field + ".g",
                   absl::StrCat("must be in [", -kMaxG, ", ", kMaxG, "], is ", medium.g));
  }
  return check_grids(field, medium, grid_maxima);
}

absl::Status check_fog(const Media& media) {
  if (index_of(*media.fog) >= media.media.size()) {
    return invalid(
        "fog", absl::StrCat("must be below ", media.media.size(), ", is ", index_of(*media.fog)));
  }
  if (media.media[index_of(*media.fog)].grids.any()) {
    return invalid("fog",
                   "must not have grids, because the fog has no boundary that gives it a space");
  }
  if (is_endless_glow(media.media[index_of(*media.fog)])) {
    return invalid("fog",
                   "must absorb or scatter where it emits: it has no end, and would be "
                   "infinitely bright");
  }
  return absl::OkStatus();
}

absl::Status check_closed(const std::string& field, const Mesh& mesh) {
  for (const auto* positions : {&mesh.positions, &mesh.positions_at_close}) {
    for (const Float3& p : *positions) {
      if (!is_finite(vec3(p))) {
        return invalid(field + ".positions", "must be finite");
      }
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
  std::vector<float> grid_maxima;
  for (std::size_t i = 0; i < media.grids.size(); ++i) {
    const absl::StatusOr<float> most = check_grid(media.grids[i]);
    if (!most.ok()) {
      return absl::InvalidArgumentError(absl::StrCat("grids[", i, "]", most.status().message()));
    }
    grid_maxima.push_back(*most);
  }
  for (std::size_t i = 0; i < media.media.size(); ++i) {
    RETURN_IF_ERROR(check_medium(absl::StrCat("media[", i, "]"), media.media[i], grid_maxima));
  }
  if (media.fog) {
    RETURN_IF_ERROR(check_fog(media));
  }
  return check_boundaries(media);
}

}  // namespace bandsaw
