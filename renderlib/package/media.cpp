// Encodes and decodes the coefficients of media, the descriptions of grids (by which media vary in
// space), and the placements of boundaries (the closed shapes that media fill).

#include "renderlib/package/media.h"

#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/material_parts.h"
#include "renderlib/package/placements.h"

namespace bandsaw {
namespace {

void encode(const GridUse& use, package::GridUse& to) {
  to.set_grid(static_cast<std::uint32_t>(use.grid));
  to.set_scale(use.scale);
}

void encode(const MediumGrids& grids, package::Medium& to) {
  if (grids.density) {
    encode(*grids.density, *to.mutable_density_grid());
  }
  if (grids.albedo) {
    encode(*grids.albedo, *to.mutable_albedo_grid());
  }
  if (grids.emission) {
    encode(*grids.emission, *to.mutable_emission_grid());
  }
  if (grids.temperature) {
    encode(*grids.temperature, *to.mutable_temperature_grid());
  }
  to.set_temperature_offset(grids.temperature_offset);
  to.set_blackbody(static_cast<package::Medium::BlackbodyScale>(grids.blackbody));
}

void encode(const VolumeGrid& grid, package::VolumeGrid& to) {
  for (const std::uint32_t side : grid.cells) {
    to.add_cells(side);
  }
  to.set_channels(grid.channels);
  // The enums are declared in the same order; the protocol's enums have an additional 0.
  to.set_format(static_cast<package::VolumeGrid::Format>(static_cast<int>(grid.format) + 1));
  to.set_filter(static_cast<package::VolumeGrid::Filter>(static_cast<int>(grid.filter) + 1));
  to.set_border(static_cast<package::VolumeGrid::Border>(static_cast<int>(grid.border) + 1));
  for (const auto& row : grid.to_medium.m) {
    for (const double entry : row) {
      to.add_to_medium(entry);
    }
  }
}

GridUse decode(const package::GridUse& from) { return {GridId{from.grid()}, from.scale()}; }

absl::StatusOr<MediumGrids> decode_grids(const package::Medium& from, const std::string& field) {
  MediumGrids grids;
  if (from.has_density_grid()) {
    grids.density = decode(from.density_grid());
  }
  if (from.has_albedo_grid()) {
    grids.albedo = decode(from.albedo_grid());
  }
  if (from.has_emission_grid()) {
    grids.emission = decode(from.emission_grid());
  }
  if (from.has_temperature_grid()) {
    grids.temperature = decode(from.temperature_grid());
  }
  grids.temperature_offset = from.temperature_offset();
  ASSIGN_OR_RETURN(grids.blackbody, decode_enum<BlackbodyScale>(from.blackbody(), /*first=*/0,
                                                                package::Medium::BlackbodyScale_MAX,
                                                                field + ".blackbody"));
  return grids;
}

absl::StatusOr<VolumeGrid> decode_grid(const package::VolumeGrid& from, const std::string& field) {
  using Proto = package::VolumeGrid;
  VolumeGrid grid;
  if (from.cells_size() != 3) {
    return manifest_error(field + ".cells",
                          absl::StrCat("must have 3 numbers, has ", from.cells_size()));
  }
  grid.cells = {from.cells(0), from.cells(1), from.cells(2)};
  grid.channels = from.channels();
  ASSIGN_OR_RETURN(grid.format, decode_enum<VolumeGrid::Format>(from.format(), Proto::Format_MAX,
                                                                field + ".format"));
  ASSIGN_OR_RETURN(grid.filter, decode_enum<VolumeGrid::Filter>(from.filter(), Proto::Filter_MAX,
                                                                field + ".filter"));
  ASSIGN_OR_RETURN(grid.border, decode_enum<VolumeGrid::Border>(from.border(), Proto::Border_MAX,
                                                                field + ".border"));
  if (from.to_medium_size() != 12) {
    return manifest_error(field + ".to_medium",
                          absl::StrCat("must have 12 numbers, has ", from.to_medium_size()));
  }
  for (int i = 0; i < 12; ++i) {
    grid.to_medium.m[static_cast<std::size_t>(i / 4)][static_cast<std::size_t>(i % 4)] =
        from.to_medium(i);
  }
  return grid;
}

}  // namespace

void encode_media(const Media& media, package::Manifest& manifest) {
  for (const Medium& medium : media.media) {
    auto& to = *manifest.add_medium();
    encode(medium.absorption, *to.mutable_absorption());
    encode(medium.scattering, *to.mutable_scattering());
    encode(medium.emission, *to.mutable_emission());
    to.set_g(medium.g);
    encode(medium.grids, to);
  }
  for (const VolumeGrid& grid : media.grids) {
    encode(grid, *manifest.add_grid());
  }
  if (media.has_boundaries()) {
    encode_placements(media.boundaries, *manifest.mutable_boundaries()->mutable_frame(),
                      *manifest.mutable_boundaries()->mutable_instance());
  }
  if (media.fog) {
    manifest.set_fog(static_cast<std::uint32_t>(*media.fog));
  }
}

absl::StatusOr<Media> decode_media(const package::Manifest& manifest) {
  Media media;
  for (int i = 0; i < manifest.medium_size(); ++i) {
    const package::Medium& from = manifest.medium(i);
    const std::string field = absl::StrCat("medium[", i, "]");
    Medium medium;
    ASSIGN_OR_RETURN(medium.absorption,
                     decode_rgb(from.absorption().rgb(), field + ".absorption.rgb"));
    ASSIGN_OR_RETURN(medium.scattering,
                     decode_rgb(from.scattering().rgb(), field + ".scattering.rgb"));
    ASSIGN_OR_RETURN(medium.emission, decode_rgb(from.emission().rgb(), field + ".emission.rgb"));
    medium.g = from.g();
    ASSIGN_OR_RETURN(medium.grids, decode_grids(from, field));
    media.media.push_back(medium);
  }
  for (int i = 0; i < manifest.grid_size(); ++i) {
    ASSIGN_OR_RETURN(VolumeGrid grid, decode_grid(manifest.grid(i), absl::StrCat("grid[", i, "]")));
    media.grids.push_back(std::move(grid));
  }
  RETURN_IF_ERROR(decode_placements(manifest.boundaries().frame(), manifest.boundaries().instance(),
                                    "boundaries.", media.boundaries));
  if (manifest.has_fog()) {
    media.fog = MediumId{manifest.fog()};
  }
  return media;
}

}  // namespace bandsaw
