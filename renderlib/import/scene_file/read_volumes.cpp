// Reads the grids of a medium from volume files, places each grid in the space of the medium, and
// adds it to the scene's grids. If several media use a grid with the same settings, it is added
// once.

#include "renderlib/import/scene_file/read_volumes.h"

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/named_file.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/volume/volume_file.h"

namespace bandsaw {
namespace {

/// Reads the map from the space of the volume file to the space of the medium's shape. An empty
/// list gives the identity.
absl::StatusOr<Transform> read_matrix(const Field& in, const Numbers& list) {
  if (list.empty()) {
    return Transform{};
  }
  if (list.size() != 12) {
    return in.error("matrix", absl::StrCat("must be 12 numbers, has ", list.size()));
  }
  Transform matrix;
  for (int i = 0; i < 12; ++i) {
    if (!std::isfinite(list[i])) {
      return in.error("matrix", absl::StrCat("must be finite, is ", list[i]), i);
    }
    matrix.m[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)] = list[i];
  }
  return inverse(matrix) ? absl::StatusOr<Transform>(matrix)
                         : in.error("matrix", "must not be singular");
}

/// Reads a grid from its file. If the scene file names no grid, reads the grid called `otherwise`,
/// or else the only grid of the file.
absl::StatusOr<FileGrid> read_file(const Field& in, const scene::VolumeGrid& from,
                                   const std::string& otherwise, SceneDraft& draft) {
  if (from.file().empty()) {
    return in.error("file", "is required: the name of a *.vdb or *.vol file");
  }
  if (!is_volume_file(from.file())) {
    return in.error("file",
                    absl::StrCat("\"", from.file(),
                                 "\" is not a volume: files of volumes end in .vdb or .vol"));
  }
  const absl::StatusOr<NamedFile> file = find_named_file(from.file(), draft);
  if (!file.ok()) {
    return in.error("file", file.status().message());
  }
  auto read = file->made != nullptr ? read_made_volume(*file->made, from.grid())
                                    : read_volume(file->key, from.grid(), otherwise);
  if (!read.ok()) {
    return in.error("file", absl::StrCat(from.file(), ": ", read.status().message()));
  }
  if (read->negative > 0) {
    draft.out.info.warnings.push_back(absl::StrCat(
        from.file(), ": ", read->negative, " numbers of its grid were below 0 and became 0"));
  }
  return read;
}

/// Reads a grid from its file and places it in the space of the medium.
absl::StatusOr<VolumeGrid> read_grid(const Field& in, const scene::VolumeGrid& from,
                                     const std::string& otherwise, SceneDraft& draft) {
  ASSIGN_OR_RETURN(FileGrid read, read_file(in, from, otherwise, draft));
  const bool has_box = !absl::EndsWithIgnoreCase(from.file(), ".vdb");
  if (from.unit_box() && !has_box) {
    return in.error("unit_box", "is for *.vol files: an OpenVDB file has no box");
  }
  if (from.clamp() && !has_box) {
    return in.error("clamp", "is for *.vol files: an OpenVDB file has no box");
  }
  ASSIGN_OR_RETURN(const Transform matrix, read_matrix(in, from.matrix()));
  VolumeGrid grid = std::move(read.grid);
  grid.to_medium = matrix * (from.unit_box() ? read.to_unit_box : grid.to_medium);
  if (!inverse(grid.to_medium)) {
    return in.error("matrix", "makes the grid too large, too small or too flat");
  }
  grid.filter = from.filter() == scene::VolumeGrid::FILTER_NEAREST ? VolumeGrid::Filter::kNearest
                                                                   : VolumeGrid::Filter::kLinear;
  grid.border = from.clamp() ? VolumeGrid::Border::kClamp : VolumeGrid::Border::kZero;
  return grid;
}

/// Returns the index of a grid among the grids of the scene, and the factor of its numbers. If no
/// grid of the scene has the same settings, the grid is read from its file. `otherwise` is the name
/// that is looked for in the file if the scene file names no grid.
absl::StatusOr<GridUse> read_use(const Field& in, const scene::VolumeGrid& from,
                                 const std::string& otherwise, SceneDraft& draft) {
  constexpr double kMaxScale = std::numeric_limits<float>::max();
  GridUse use;
  if (from.has_scale()) {
    RETURN_IF_ERROR(check_range(in, "scale", from.scale(), 0, kMaxScale));
    use.scale = static_cast<float>(from.scale());
  }
  scene::VolumeGrid unscaled = from;
  unscaled.clear_scale();
  if (unscaled.grid().empty()) {
    unscaled.set_grid(otherwise);
  }
  std::vector<VolumeGrid>& grids = draft.out.scene.media.grids;
  const auto [known, is_new] = draft.volumes.try_emplace(
      unscaled.SerializeAsString(), GridId{static_cast<std::uint32_t>(grids.size())});
  if (is_new) {
    ASSIGN_OR_RETURN(VolumeGrid grid, read_grid(in, from, otherwise, draft));
    grids.push_back(std::move(grid));
  }
  use.grid = known->second;
  return use;
}

absl::Status read_temperature(const Field& in, const scene::Medium& from, SceneDraft& draft,
                              MediumGrids& grids) {
  if (!from.has_temperature_grid()) {
    if (from.has_temperature_scale() || from.has_temperature_offset()) {
      return in.error(from.has_temperature_scale() ? "temperature_scale" : "temperature_offset",
                      "needs a temperature_grid");
    }
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(grids.temperature, read_use(in.child("temperature_grid"),
                                               from.temperature_grid(), "temperature", draft));
  if (from.has_temperature_scale()) {
    RETURN_IF_ERROR(check_range(in, "temperature_scale", from.temperature_scale(), 0, 1e9));
    grids.temperature->scale *= static_cast<float>(from.temperature_scale());
  }
  RETURN_IF_ERROR(check_range(in, "temperature_offset", from.temperature_offset(), -1e9, 1e9));
  grids.temperature_offset = from.temperature_offset();
  grids.blackbody = from.blackbody() == scene::Medium::BLACKBODY_PEAK ? BlackbodyScale::kPeak
                                                                      : BlackbodyScale::kPower;
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<MediumGrids> read_grids(const Field& in, const scene::Medium& from,
                                       SceneDraft& draft) {
  MediumGrids grids;
  if (from.has_density_grid()) {
    ASSIGN_OR_RETURN(grids.density,
                     read_use(in.child("density_grid"), from.density_grid(), "density", draft));
  }
  if (from.has_albedo_grid()) {
    if (from.has_albedo() || from.has_absorption() || from.has_scattering()) {
      return in.error("albedo_grid",
                      "write albedo_grid, or albedo, absorption and scattering, not both");
    }
    ASSIGN_OR_RETURN(grids.albedo,
                     read_use(in.child("albedo_grid"), from.albedo_grid(), "albedo", draft));
  }
  if (from.has_emission_grid()) {
    ASSIGN_OR_RETURN(grids.emission,
                     read_use(in.child("emission_grid"), from.emission_grid(), "emission", draft));
  }
  RETURN_IF_ERROR(read_temperature(in, from, draft, grids));
  return grids;
}

}  // namespace bandsaw
