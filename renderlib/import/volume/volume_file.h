#pragma once

// Reads files with grids of numbers over space, from which media such as smoke are made: Mitsuba's
// *.vol and OpenVDB's *.vdb.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// A grid that was read from a file.
struct FileGrid {
  /// `grid.to_medium` maps the cells to the file's space. In a *.vdb file, the map comes from the
  /// transform of the grid. In a *.vol file, it comes from the box that the file gives.
  VolumeGrid grid;
  /// The map from the cells of `grid` to the unit cube [0, 1]^3. It is set for *.vol files only.
  Transform to_unit_box;
  std::uint64_t negative = 0;  ///< numbers below 0 that became 0
};

/// Returns true if the name ends in .vol or .vdb, so that read_volume() can read the file.
bool is_volume_file(const std::string& name);

/// Reads the grid called `grid` of a file. If `grid` is empty, reads the grid called `otherwise`,
/// or else the only grid of the file. A *.vol file has one grid without a name, so `grid` must be
/// empty. Returns INVALID_ARGUMENT if the file is damaged or of another kind, if it has no such
/// grid, or if a number is not finite. Returns RESOURCE_EXHAUSTED if the grid is too large.
/// Messages of errors do not name the file.
absl::StatusOr<FileGrid> read_volume(const std::string& path, const std::string& grid,
                                     const std::string& otherwise);

/// Reads a *.vol file that a converter made in memory. `bytes` is its content. `grid` must be
/// empty. Errors are those of read_volume().
absl::StatusOr<FileGrid> read_made_volume(const std::string& bytes, const std::string& grid);

/// Reads the bytes of a *.vol file (vol_file.cpp says how they are laid out).
absl::StatusOr<FileGrid> read_vol(absl::Span<const std::byte> bytes);

/// Reads a *.vdb file. Arguments and errors are those of read_volume().
absl::StatusOr<FileGrid> read_vdb(const std::string& path, const std::string& grid,
                                  const std::string& otherwise);

}  // namespace bandsaw
