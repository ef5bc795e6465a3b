// The program `bandsaw`: parses the arguments, hides the secrets in the arguments from other users
// of the machine, and runs the command. Each command has a function run() (cli/options/commands.h).

#include <new>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/cli/command_line.h"
#include "coordinator/cli/options/commands.h"
#include "proto/link/channel.h"
#include "proto/link/join.h"

namespace bandsaw::coordinator {
namespace {

/// Runs the command and returns its exit code. If memory cannot be allocated (std::bad_alloc),
/// prints an error and returns kFailed.
ExitCode run_command(const Command& command, Process& process) {
  try {
    return std::visit([&](const auto& options) { return run(options, process); }, command);
  } catch (const std::bad_alloc&) {
    return process.console.fail(ExitCode::kFailed, "not enough memory");
  }
}

}  // namespace
}  // namespace bandsaw::coordinator

int main(int argc, char** argv) {
  using namespace bandsaw::coordinator;
  const Console console = Console::standard();
  const auto command =
      parse_command_line(std::vector<std::string>(argv + (argc > 0 ? 1 : 0), argv + argc));
  bandsaw::link::hide_join_strings({argv, static_cast<std::size_t>(argc)});
  if (!command.ok()) {
    return static_cast<int>(
        console.fail(ExitCode::kWrong, std::string(command.status().message())));
  }
  // Lets gRPC look up host names by the system's resolver, which knows more names than gRPC's own
  // resolver.
  bandsaw::link::use_system_resolver();
  Interrupts interrupts;
  Process process{console, interrupts};
  const ExitCode code = run_command(*command, process);
  if (const absl::Status written = console.write_error();
      code == ExitCode::kDone && !written.ok()) {
    return static_cast<int>(console.fail(ExitCode::kFailed, std::string(written.message())));
  }
  return static_cast<int>(code);
}
