// The commands `bandsaw invite` and `bandsaw dismiss`, which install and remove workers on other
// machines by ssh.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/machines/remote_hosts.h"
#include "coordinator/cli/machines/remote_scripts.h"
#include "coordinator/cli/machines/worker_file.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/web/worker_program.h"
#include "proto/link/join.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Starts workers on other machines: asks a host for its architecture, then sends the program for
/// that architecture.
class Invitation {
 public:
  /// Reads the installed programs of workers, one for each architecture. `join`: the workers' join
  /// string (the addresses of the farm and a secret), which each worker gets. If none of the
  /// programs can be sent, returns the error of the program for this machine's own architecture.
  static absl::StatusOr<Invitation> create(const std::string& join);

  /// Installs and starts a worker on `host`, in at most `seconds`; ends soon after `stop` is set.
  /// If there is no program for the host's architecture, the outcome says how to get one.
  /// Thread-safe.
  RemoteOutcome invite(const std::string& host, double seconds,
                       const std::atomic<bool>& stop) const;

 private:
  using Scripts = std::map<Machine, absl::StatusOr<RemoteScript>>;
  Invitation(RemoteScript machine_query, Scripts scripts)
      : machine_query_(std::move(machine_query)), scripts_(std::move(scripts)) {}
  RemoteScript machine_query_;
  Scripts scripts_;  // one for every architecture; an error says why its program cannot be sent
};

/// Returns the script that installs a worker, with the program for `machine` as its input.
absl::StatusOr<RemoteScript> script_for(Machine machine, const std::string& join) {
  ASSIGN_OR_RETURN(const WorkerProgram program, load_worker_program(machine));
  return RemoteScript::create(invite_script(program.bytes.size(), program.digest),
                              absl::StrCat(join, "\n", program.bytes));
}

/// Parses the architecture from the output of machine_script, such as "Linux x86_64".
/// INVALID_ARGUMENT: workers are not built for this system or architecture.
absl::StatusOr<Machine> machine_of(absl::string_view output) {
  absl::string_view name = output;
  const bool linux_system = absl::ConsumePrefix(&name, "Linux ");
  const std::optional<Machine> machine = machine_named(name);
  if (linux_system && machine) {
    return *machine;
  }
  constexpr std::size_t kMaxColumns = 60;  // enough for every real name
  return absl::InvalidArgumentError(
      absl::StrCat("there is no worker for this machine (uname says: ", fit(output, kMaxColumns),
                   "); workers run on Linux, on ",
                   absl::StrJoin(kMachines, " or ", [](std::string* out, Machine one) {
                     absl::StrAppend(out, machine_name(one));
                   })));
}

absl::StatusOr<Invitation> Invitation::create(const std::string& join) {
  ASSIGN_OR_RETURN(RemoteScript machine_query, RemoteScript::create(machine_script()));
  Scripts scripts;
  for (const Machine machine : kMachines) {
    scripts.emplace(machine, script_for(machine, join));
  }
  if (std::none_of(scripts.begin(), scripts.end(),
                   [](const auto& script) { return script.second.ok(); })) {
    return scripts.at(kThisMachine).status();
  }
  return Invitation(std::move(machine_query), std::move(scripts));
}

RemoteOutcome Invitation::invite(const std::string& host, double seconds,
                                 const std::atomic<bool>& stop) const {
  const auto begin = std::chrono::steady_clock::now();
  RemoteOutcome outcome = machine_query_.run(host, seconds, stop);
  if (!outcome.ok) {
    return outcome;
  }
  outcome.ok = false;
  const absl::StatusOr<Machine> machine = machine_of(outcome.what);
  if (!machine.ok()) {
    outcome.what = std::string(machine.status().message());
    return outcome;
  }
  const absl::StatusOr<RemoteScript>& script = scripts_.at(*machine);
  if (!script.ok()) {
    outcome.what = std::string(script.status().message());
    return outcome;
  }
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
  return script->run(host, seconds - passed.count(), stop);
}

/// Returns the workers' join string: the given one, or that of the farm served from this account.
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
        "--join: this join string is for users; workers need the one in the file `join` of the "
        "coordinator's data folder");
  }
  return join;
}

/// The work for one host. It ends soon after `stop` is set.
using HostWork =
    std::function<RemoteOutcome(const std::string& host, const std::atomic<bool>& stop)>;

/// Does `work` for all hosts at the same time. Prints the result of each host as soon as it is
/// known, and at the end the number of successes. `event`: "invited" or "dismissed", which begins
/// the last line and is the kind of the JSON events.
ExitCode on_hosts(const std::vector<std::string>& hosts, const char* event, const HostWork& work,
                  const Verbosity& verbosity, Process& process) {
  std::atomic<bool> stop = false;
  const Interrupts::Listener listener(process.interrupts, [&stop] { stop = true; });
  std::size_t good = 0;
  const auto report = [&](const RemoteOutcome& outcome) {
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
      hosts, [&](const std::string& host) { return work(host, stop); }, report);
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
  // The connection and the shell need time in addition to the drain, in which a worker finishes the
  // rows that it is rendering.
  constexpr double kExtra_s = 30;
  const auto script =
      RemoteScript::create(dismiss_script(static_cast<int>(std::ceil(options.drain_s))));
  if (!script.ok()) {
    return finished(script.status(), process.console);
  }
  const HostWork work = [&](const std::string& host, const std::atomic<bool>& stop) {
    return script->run(host, options.drain_s + kExtra_s, stop);
  };
  return on_hosts(options.hosts, "dismissed", work, options.verbosity, process);
}

}  // namespace bandsaw::coordinator
