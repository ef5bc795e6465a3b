// bandsaw invite, bandsaw dismiss: workers of other machines, by ssh.

#include <cmath>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/machines/remote_hosts.h"
#include "coordinator/cli/machines/remote_scripts.h"
#include "coordinator/cli/machines/worker_program.h"
#include "coordinator/cli/options/commands.h"
#include "proto/link/join.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// The workers' join string: as given, or of the farm that is served from this account.
absl::StatusOr<link::JoinString> workers_join(const InviteOptions& options) {
  std::string from = options.join;
  if (from.empty()) {
    std::string folder = options.data;
    if (folder.empty()) {
      ASSIGN_OR_RETURN(folder, default_data_folder());
    }
    from = worker_join_file(folder);
    if (!file_exists(from)) {
      return absl::InvalidArgumentError(
          absl::StrCat("no farm is served from here (there is no ", from,
                       "): start bandsaw serve, or name the workers' join string with --join"));
    }
  }
  ASSIGN_OR_RETURN(link::JoinString join, link::join_string_from(from));
  if (join.role != link::Role::kWorker) {
    return absl::InvalidArgumentError(
        "--join: this join string is for people; workers need the one in the file `join` of the "
        "coordinator's data folder");
  }
  return join;
}

/// Says how it went on each host as it is known, and then how many.
ExitCode on_hosts(const std::vector<std::string>& hosts, const char* event,
                  const std::string& script, const std::string& input, double seconds,
                  const Verbosity& verbosity, Process& process) {
  std::atomic<bool> stop = false;
  const Interrupts::Listener listener(process.interrupts, [&stop] { stop = true; });
  std::size_t good = 0;
  const absl::Status status =
      run_on_hosts(hosts, script, input, seconds, stop, [&](const RemoteOutcome& outcome) {
        good += outcome.ok ? 1 : 0;
        if (verbosity.json) {
          process.console.line(JsonObject()
                                   .text("event", event)
                                   .text("host", outcome.host)
                                   .flag("ok", outcome.ok)
                                   .text("found", outcome.what)
                                   .str());
        } else if (!outcome.ok) {
          process.console.complain(absl::StrCat(outcome.host, ": ", outcome.what));
        } else if (!verbosity.quiet) {
          process.console.line(absl::StrCat(outcome.host, ": ", outcome.what));
        }
      });
  if (!status.ok()) {
    return finished(status, process.console);
  }
  if (!verbosity.json) {
    process.console.line(absl::StrCat(event, ": ", good, " of ", hosts.size(),
                                      hosts.size() == 1 ? " host" : " hosts"));
  }
  if (stop) {
    return ExitCode::kInterrupted;
  }
  return good == hosts.size() ? ExitCode::kDone : ExitCode::kFailed;
}

}  // namespace

ExitCode run(const InviteOptions& options, Process& process) {
  const auto join = workers_join(options);
  if (!join.ok()) {
    return finished(join.status(), process.console);
  }
  const auto program = load_worker_program();
  if (!program.ok()) {
    return finished(program.status(), process.console);
  }
  return on_hosts(options.hosts, "invited", invite_script(program->bytes.size(), program->digest),
                  absl::StrCat(join->text(), "\n", program->bytes), options.seconds,
                  options.verbosity, process);
}

ExitCode run(const DismissOptions& options, Process& process) {
  // Beside the drain the connection and the shell need their time.
  constexpr double kAround = 30;
  return on_hosts(options.hosts, "dismissed",
                  dismiss_script(static_cast<int>(std::ceil(options.drain_s))), "",
                  options.drain_s + kAround, options.verbosity, process);
}

}  // namespace bandsaw::coordinator
