#pragma once

// Parses the arguments of the program into a checked command. main() calls it. The table of all
// commands is in command_line.cpp.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"

namespace bandsaw::coordinator {

/// Parses `arguments`, which are without the program's name. INVALID_ARGUMENT: the arguments are
/// wrong; the message is one line and names the command or option that was probably meant, if there
/// is one.
absl::StatusOr<Command> parse_command_line(const std::vector<std::string>& arguments);

}  // namespace bandsaw::coordinator
