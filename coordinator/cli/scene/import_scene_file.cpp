#include "coordinator/cli/scene/import_scene_file.h"

#include <atomic>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/scene/blend_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process, const SceneChoices& choices) {
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  ImportLimits limits;
  limits.stop = &stop;
  std::string file = scene;
  std::unique_ptr<BlendScene> blend;
  if (is_blend_file(scene)) {
    ASSIGN_OR_RETURN(blend, scene_of_blend_file(scene, stop));
    file = blend->scene;
    print_warnings(blend->warnings, verbosity, process);
  }
  auto package = import_in_process(file, limits, choices);
  if (!package.ok()) {
    return package;
  }
  if (stop) {
    return absl::CancelledError("interrupted");
  }
  print_warnings(package->info().warnings, verbosity, process);
  return package;
}

void print_warnings(const std::vector<std::string>& warnings, Verbosity verbosity,
                    Process& process) {
  for (const std::string& warning : warnings) {
    if (verbosity.json) {
      process.console.line(JsonObject().text("event", "warning").text("text", warning).str());
    } else if (!verbosity.quiet) {
      process.console.complain(absl::StrCat("warning: ", warning));
    }
  }
}

ExitCode import_exit_code(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kCancelled:
      return ExitCode::kInterrupted;
    case absl::StatusCode::kFailedPrecondition:
    case absl::StatusCode::kInternal:
      return ExitCode::kFailed;
    default:
      return ExitCode::kWrong;
  }
}

}  // namespace bandsaw::coordinator
