// The command `bandsaw doctor`: checks this machine and the farm that it uses, and prints one line
// for each check. It succeeds only if all checks do.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/machines/doctor_checks.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {
namespace {

/// Runs all checks. `folder`: the coordinator's data folder; empty: it is unknown.
std::vector<Check> all_checks(const DoctorOptions& options, const std::string& folder) {
  std::vector<Check> checks = {check_data_folder(folder), check_memory(), check_import_program(),
                               check_worker_programs()};
  // The join string: a line with the addresses of a farm and a secret.
  const auto join = doctor_join(options.farm, folder);
  FarmChecks of_farm;
  std::vector<std::string> own;
  if (join.ok()) {
    of_farm = check_farm(*join);
    own = join->addresses;
  } else {
    // Having no farm is not an error: a coordinator may be started on this machine later.
    of_farm.checks = {
        {"farm", absl::IsNotFound(join.status()), std::string(join.status().message())}};
  }
  checks.push_back(check_port(options.listen, of_farm.answered, own));
  checks.insert(checks.end(), of_farm.checks.begin(), of_farm.checks.end());
  return checks;
}

}  // namespace

ExitCode run(const DoctorOptions& options, Process& process) {
  std::string folder = options.data;
  if (folder.empty()) {
    folder = default_data_folder().value_or("");
  }
  const std::vector<Check> checks = all_checks(options, folder);
  for (const Check& check : checks) {
    if (options.verbosity.json) {
      process.console.line(JsonObject()
                               .text("event", "check")
                               .text("name", check.name)
                               .flag("ok", check.ok)
                               .text("found", check.found)
                               .str());
    } else if (!check.ok || !options.verbosity.quiet) {
      process.console.line(absl::StrCat(check.ok ? "ok       " : "problem  ",
                                        pad_right(check.name, 12), "  ", printable(check.found)));
    }
  }
  const bool well = std::all_of(checks.begin(), checks.end(), [](const Check& c) { return c.ok; });
  return well ? ExitCode::kDone : ExitCode::kFailed;
}

}  // namespace bandsaw::coordinator
