// find_farm() takes the join string (a line with the addresses of a farm and a secret) from --farm,
// from BANDSAW_FARM, or from the file of a farm on this machine, in this order.

#include "coordinator/cli/farm/find_farm.h"

#include <cstdlib>
#include <filesystem>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Where the join string comes from.
struct Source {
  std::string name;  ///< for errors: an option, a variable or a file
  std::string text;  ///< the join string, the file that has it, or "-" for standard input
};

/// Returns the first source that names a farm. UNAVAILABLE: there is none.
absl::StatusOr<Source> source_of(const FarmOption& option) {
  if (!option.farm.empty()) {
    return Source{"--farm", option.farm};
  }
  if (const char* farm = std::getenv("BANDSAW_FARM"); farm != nullptr && *farm != '\0') {
    return Source{"BANDSAW_FARM", farm};
  }
  constexpr char kCure[] =
      "no farm is named: give its join string with --farm or BANDSAW_FARM, or start one here with: "
      "bandsaw serve";
  const auto folder = default_data_folder();
  if (!folder.ok()) {
    return absl::UnavailableError(kCure);
  }
  const std::string file = farm_join_file(*folder);
  std::error_code error;
  if (!std::filesystem::exists(file, error)) {
    return absl::UnavailableError(absl::StrCat(kCure, " (there is no ", file, ")"));
  }
  return Source{file, file};
}

}  // namespace

absl::StatusOr<link::JoinString> find_farm(const FarmOption& option) {
  ASSIGN_OR_RETURN(const Source source, source_of(option));
  auto join = link::join_string_from(source.text);
  if (!join.ok()) {
    return absl::Status(join.status().code(),
                        absl::StrCat(source.name, ": ", join.status().message()));
  }
  if (join->role != link::Role::kFarm) {
    return absl::InvalidArgumentError(absl::StrCat(source.name,
                                                   ": this is the join string of workers; users "
                                                   "need the join string in the file `farm` of the "
                                                   "coordinator's data folder"));
  }
  return join;
}

}  // namespace bandsaw::coordinator
