// Finds the coordinator's data folder and names the files in it. The folder follows the XDG Base
// Directory Specification: a variable with a relative path counts as not set.

#include "coordinator/cli/base/data_folder.h"

#include <cstdlib>

namespace bandsaw::coordinator {

absl::StatusOr<std::string> default_data_folder() {
  if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && *data == '/') {
    return std::string(data) + "/bandsaw";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return std::string(home) + "/.local/share/bandsaw";
  }
  return absl::FailedPreconditionError(
      "neither XDG_DATA_HOME nor HOME is set; name the folder with --data DIR");
}

// The files `join` and `farm` have the join strings of workers and of users. A join string has the
// addresses of the farm and a secret.
std::string worker_join_file(const std::string& data_folder) { return data_folder + "/join"; }
std::string farm_join_file(const std::string& data_folder) { return data_folder + "/farm"; }
std::string dashboard_file(const std::string& data_folder) { return data_folder + "/dashboard"; }

}  // namespace bandsaw::coordinator
