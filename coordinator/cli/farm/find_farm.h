#pragma once

// Determines which farm a command uses.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {

/// Returns the join string that --farm gives, else BANDSAW_FARM, else the default data folder. A
/// join string is a line with the addresses of a farm, the digest of its certificate and a secret.
/// UNAVAILABLE: none of the three names a farm. INVALID_ARGUMENT: the text is no join string, or
/// one for workers. Other errors: the file cannot be read.
absl::StatusOr<link::JoinString> find_farm(const FarmOption& option);

}  // namespace bandsaw::coordinator
