#pragma once

// From arguments to a checked command. The table of commands and options is here and nowhere else.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// `arguments` without the program's name. INVALID_ARGUMENT: one line that says what is wrong and,
/// where there is one, the command or option that was probably meant.
absl::StatusOr<Command> parse_command_line(const std::vector<std::string>& arguments);

}  // namespace bandsaw::coordinator
