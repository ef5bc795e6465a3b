#pragma once

// Maps errors of a farm to exit codes of a command.

#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/cli/base/console.h"
#include "coordinator/cli/base/exit_code.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Finds the farm and connects to it. Errors as find_farm and FarmClient::connect.
absl::StatusOr<std::unique_ptr<FarmClient>> connect_to_farm(const FarmOption& option);

/// UNAVAILABLE, DEADLINE_EXCEEDED: kNoFarm. INVALID_ARGUMENT, UNAUTHENTICATED, PERMISSION_DENIED:
/// kWrong (for example, the wrong join string). CANCELLED: kInterrupted. Others: kFailed.
ExitCode exit_code_of(const absl::Status& status);

/// Prints the error, if any, and returns the exit code of a command.
ExitCode finished(const absl::Status& status, const Console& console);

}  // namespace bandsaw::coordinator
