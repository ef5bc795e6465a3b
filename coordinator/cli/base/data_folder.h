#pragma once

// Finds the coordinator's data folder and names the files in it that other commands read. A join
// string is a line with the addresses of a farm, the digest of its certificate and a secret.

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Returns the default data folder: $XDG_DATA_HOME/bandsaw or ~/.local/share/bandsaw.
/// FAILED_PRECONDITION: neither XDG_DATA_HOME nor HOME is an absolute path.
absl::StatusOr<std::string> default_data_folder();

/// Returns the path of the file with the join string of workers.
std::string worker_join_file(const std::string& data_folder);
/// Returns the path of the file with the join string of users.
std::string farm_join_file(const std::string& data_folder);
/// Returns the path of the file with the link to the dashboard. The link has the users' secret.
std::string dashboard_file(const std::string& data_folder);

}  // namespace bandsaw::coordinator
