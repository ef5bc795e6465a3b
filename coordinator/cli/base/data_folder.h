#pragma once

// Where a coordinator keeps its data, and where its join strings lie.

#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// The folder when none is named: $XDG_DATA_HOME/bandsaw or ~/.local/share/bandsaw.
/// FAILED_PRECONDITION: neither variable is set.
absl::StatusOr<std::string> default_data_folder();

/// Files in the data folder: the join string of workers, and of people.
std::string worker_join_file(const std::string& data_folder);
std::string farm_join_file(const std::string& data_folder);
/// The link to the dashboard, with people's secret in it.
std::string dashboard_file(const std::string& data_folder);

}  // namespace bandsaw::coordinator
