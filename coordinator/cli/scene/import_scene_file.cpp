#include "coordinator/cli/scene/import_scene_file.h"

#include <atomic>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/scene/blend_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::StatusOr<ImportedPackage> import_any_scene(const std::string& scene,
                                                 const SceneChoices& choices,
                                                 const std::atomic<bool>& stop,
                                                 std::vector<std::string>& warnings) {
  ImportLimits limits;
  limits.stop = &stop;
  if (!is_blend_file(scene)) {
    return import_in_process(scene, limits, choices);
  }
  if (choices.shutter) {
    return absl::InvalidArgumentError(
        absl::StrCat(scene, ": the shutter is that of the file; omit --shutter"));
  }
  ASSIGN_OR_RETURN(const std::unique_ptr<BlendScene> blend,
                   scene_of_blend_file(scene, stop, choices.frame));
  warnings = blend->warnings;
  SceneChoices still = choices;  // Blender has set the frame
  still.frame.reset();
  still.fps.reset();
  return import_in_process(blend->scene, limits, still);
}

absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process, const SceneChoices& choices) {
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  std::vector<std::string> warnings;
  auto package = import_any_scene(scene, choices, stop, warnings);
  print_warnings(warnings, verbosity, process);
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
