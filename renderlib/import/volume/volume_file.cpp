// Chooses the reader of a volume file by its suffix. A *.vol file has a single grid without a name.

#include "renderlib/import/volume/volume_file.h"

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/mapped_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

/// Returns INVALID_ARGUMENT unless the name `grid` is empty, because the grid of a *.vol file has
/// no name.
absl::Status check_no_name(const std::string& grid) {
  return grid.empty() ? absl::OkStatus()
                      : absl::InvalidArgumentError(
                            absl::StrCat("has one grid, without a name: leave out \"", grid, "\""));
}

}  // namespace

bool is_volume_file(const std::string& name) {
  return absl::EndsWithIgnoreCase(name, ".vol") || absl::EndsWithIgnoreCase(name, ".vdb");
}

absl::StatusOr<FileGrid> read_volume(const std::string& path, const std::string& grid,
                                     const std::string& otherwise) {
  if (absl::EndsWithIgnoreCase(path, ".vdb")) {
    return read_vdb(path, grid, otherwise);
  }
  RETURN_IF_ERROR(check_no_name(grid));
  ASSIGN_OR_RETURN(const MappedFile file, MappedFile::open(path));
  return read_vol(file.bytes());
}

absl::StatusOr<FileGrid> read_made_volume(const std::string& bytes, const std::string& grid) {
  RETURN_IF_ERROR(check_no_name(grid));
  return read_vol({reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()});
}

}  // namespace bandsaw
