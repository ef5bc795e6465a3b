#include "coordinator/cli/machines/invitation.h"

#include <algorithm>
#include <chrono>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/machines/remote_scripts.h"
#include "coordinator/cli/machines/worker_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

absl::StatusOr<RemoteScript> script_for(Machine machine, const std::string& join) {
  ASSIGN_OR_RETURN(const WorkerProgram program, load_worker_program(machine));
  return RemoteScript::create(invite_script(program.bytes.size(), program.digest),
                              absl::StrCat(join, "\n", program.bytes));
}

/// The architecture in the answer to machine_script. INVALID_ARGUMENT: workers are not built for
/// it.
absl::StatusOr<Machine> machine_of(absl::string_view said) {
  absl::string_view name = said;
  const bool linux_system = absl::ConsumePrefix(&name, "Linux ");
  const std::optional<Machine> machine = machine_named(name);
  if (linux_system && machine) {
    return *machine;
  }
  constexpr std::size_t kMaxColumns = 60;  // enough for every real name
  return absl::InvalidArgumentError(
      absl::StrCat("it is a machine of another kind (uname says: ", fit(said, kMaxColumns),
                   "); workers run on Linux, on ",
                   absl::StrJoin(kMachines, " or ", [](std::string* out, Machine one) {
                     absl::StrAppend(out, machine_name(one));
                   })));
}

}  // namespace

absl::StatusOr<Invitation> Invitation::create(const std::string& join) {
  ASSIGN_OR_RETURN(RemoteScript ask, RemoteScript::create(machine_script()));
  Scripts scripts;
  for (const Machine machine : kMachines) {
    scripts.emplace(machine, script_for(machine, join));
  }
  if (std::none_of(scripts.begin(), scripts.end(),
                   [](const auto& script) { return script.second.ok(); })) {
    return scripts.at(kThisMachine).status();
  }
  return Invitation(std::move(ask), std::move(scripts));
}

RemoteOutcome Invitation::invite(const std::string& host, double seconds,
                                 const std::atomic<bool>& stop) const {
  const auto begin = std::chrono::steady_clock::now();
  RemoteOutcome outcome = ask_.run(host, seconds, stop);
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

}  // namespace bandsaw::coordinator
