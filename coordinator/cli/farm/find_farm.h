#pragma once

// Which farm a command means, and the way to it.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// The join string of --farm, then of BANDSAW_FARM, then of the default data folder. UNAVAILABLE:
/// nothing names a farm. INVALID_ARGUMENT: it is not a join string, or not one for people. Others:
/// the file cannot be read.
absl::StatusOr<link::JoinString> find_farm(const FarmOption& option);

}  // namespace bandsaw::coordinator
