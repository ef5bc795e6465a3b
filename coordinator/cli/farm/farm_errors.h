#pragma once

// What a farm's answers mean for a command.

#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/cli/base/console.h"
#include "coordinator/cli/base/exit_code.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Finds the farm and connects. Errors as find_farm and FarmClient::connect.
absl::StatusOr<std::unique_ptr<FarmClient>> connect_to_farm(const FarmOption& option);

/// UNAVAILABLE, DEADLINE_EXCEEDED: no farm. INVALID_ARGUMENT, UNAUTHENTICATED, PERMISSION_DENIED:
/// wrong use (the wrong join string among it). CANCELLED: interrupted. Others: failed.
ExitCode exit_code_of(const absl::Status& status);

/// How a command ends; complains of an error.
ExitCode finished(const absl::Status& status, const Console& console);

}  // namespace bandsaw::coordinator
