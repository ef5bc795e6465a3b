#pragma once

// Determines the farm that a command should use.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// Returns the join string given by --farm, else by BANDSAW_FARM, else by the default data folder.
/// UNAVAILABLE: none of them names a farm. INVALID_ARGUMENT: not a join string, or one for workers.
/// Other errors: the file cannot be read.
absl::StatusOr<link::JoinString> find_farm(const FarmOption& option);

}  // namespace bandsaw::coordinator
