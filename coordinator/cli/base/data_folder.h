#pragma once

// Locations of the coordinator's data folder and of its join strings.

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Returns the default data folder: $XDG_DATA_HOME/bandsaw or ~/.local/share/bandsaw.
/// FAILED_PRECONDITION: neither variable is set.
absl::StatusOr<std::string> default_data_folder();

/// These functions return the paths of the files with the join strings of workers and of users.
std::string worker_join_file(const std::string& data_folder);
std::string farm_join_file(const std::string& data_folder);
/// Returns the file with the link to the dashboard, which contains the users' secret.
std::string dashboard_file(const std::string& data_folder);

}  // namespace bandsaw::coordinator
