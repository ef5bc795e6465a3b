// bandsaw invite, bandsaw dismiss: workers of other machines, by ssh.

#include <cmath>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/machines/invitation.h"
#include "coordinator/cli/machines/remote_hosts.h"
#include "coordinator/cli/machines/remote_scripts.h"
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

/// What is done to one host, until `stop` is set.
using HostWork =
    std::function<RemoteOutcome(const std::string& host, const std::atomic<bool>& stop)>;

/// Prints how it went on each host as soon as it is known, and at the end how many went well.
ExitCode on_hosts(const std::vector<std::string>& hosts, const char* event, const HostWork& work,
                  const Verbosity& verbosity, Process& process) {
  std::atomic<bool> stop = false;
  const Interrupts::Listener listener(process.interrupts, [&stop] { stop = true; });
  std::size_t good = 0;
  const auto tell = [&](const RemoteOutcome& outcome) {
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
  };
  for_each_host(
      hosts, [&](const std::string& host) { return work(host, stop); }, tell);
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
  const auto invitation = Invitation::create(join->text());
  if (!invitation.ok()) {
    return finished(invitation.status(), process.console);
  }
  const HostWork work = [&](const std::string& host, const std::atomic<bool>& stop) {
    return invitation->invite(host, options.seconds, stop);
  };
  return on_hosts(options.hosts, "invited", work, options.verbosity, process);
}

ExitCode run(const DismissOptions& options, Process& process) {
  // Beside the drain the connection and the shell need their time.
  constexpr double kAround = 30;
  const auto script =
      RemoteScript::create(dismiss_script(static_cast<int>(std::ceil(options.drain_s))));
  if (!script.ok()) {
    return finished(script.status(), process.console);
  }
  const HostWork work = [&](const std::string& host, const std::atomic<bool>& stop) {
    return script->run(host, options.drain_s + kAround, stop);
  };
  return on_hosts(options.hosts, "dismissed", work, options.verbosity, process);
}

}  // namespace bandsaw::coordinator
