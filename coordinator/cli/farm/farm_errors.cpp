// Connects to the farm that the options name, and maps the status of a call to the program's exit
// code.

#include "coordinator/cli/farm/farm_errors.h"

#include "coordinator/cli/farm/find_farm.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::StatusOr<std::unique_ptr<FarmClient>> connect_to_farm(const FarmOption& option) {
  ASSIGN_OR_RETURN(const link::JoinString join, find_farm(option));
  return FarmClient::connect(join);
}

ExitCode exit_code_of(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return ExitCode::kDone;
    case absl::StatusCode::kUnavailable:
    case absl::StatusCode::kDeadlineExceeded:
      return ExitCode::kNoFarm;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kUnauthenticated:
    case absl::StatusCode::kPermissionDenied:
      return ExitCode::kWrong;
    case absl::StatusCode::kCancelled:
      return ExitCode::kInterrupted;
    default:
      return ExitCode::kFailed;
  }
}

ExitCode finished(const absl::Status& status, const Console& console) {
  return status.ok() ? ExitCode::kDone
                     : console.fail(exit_code_of(status), std::string(status.message()));
}

}  // namespace bandsaw::coordinator
