#pragma once

// Determines which farm a command uses.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// Returns the join string of the farm. A join string is a line with the addresses of a farm, the
/// digest of its certificate and a secret. There are three sources: the option --farm, the variable
/// BANDSAW_FARM, and the join file of a farm in the default data folder. The first source that is
/// set is used. The option and the variable hold the join string itself, the name of a file with
/// the join string, or "-" for standard input.
/// UNAVAILABLE: no source is set. INVALID_ARGUMENT: the text is not a join string, or it is a join
/// string for workers. Other errors: the file with the join string cannot be read.
absl::StatusOr<link::JoinString> find_farm(const FarmOption& option);

}  // namespace bandsaw::coordinator
