#pragma once

// Parses arguments into a checked command. Its implementation has the only table of commands and
// options.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Parses `arguments`, which do not contain the program's name. INVALID_ARGUMENT: one line with the
/// error and, if there is one, the command or option that was probably meant.
absl::StatusOr<Command> parse_command_line(const std::vector<std::string>& arguments);

}  // namespace bandsaw::coordinator
