#pragma once

// Connects a command to its farm, and maps errors of a farm to exit codes of the command.

#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/cli/base/console.h"
#include "coordinator/cli/base/exit_code.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Finds the farm and connects to it. The errors are those of find_farm() and
/// FarmClient::connect().
absl::StatusOr<std::unique_ptr<FarmClient>> connect_to_farm(const FarmOption& option);

/// Returns kDone for OK; kNoFarm for UNAVAILABLE and DEADLINE_EXCEEDED; kWrong for
/// INVALID_ARGUMENT, UNAUTHENTICATED and PERMISSION_DENIED, such as a wrong join string (the
/// addresses of the farm and a secret);
/// kInterrupted for CANCELLED; kFailed for all others.
ExitCode exit_code_of(const absl::Status& status);

/// If `status` is an error, prints its message. Returns exit_code_of(status). Commands end with a
/// call of finished().
ExitCode finished(const absl::Status& status, const Console& console);

}  // namespace bandsaw::coordinator
