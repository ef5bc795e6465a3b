// Imports the scenes that users name. The importer, a process with limited rights, reads every
// scene (import_process.h). Before that, Blender converts a .blend file to a scene file
// (blend_file.h).

#include "coordinator/cli/scene/import_scene_file.h"

#include <atomic>
#include <functional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/scene/blend_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Imports a scene. `stop`: another thread sets it to end the import. `warnings` receives the
/// warnings of Blender.
using Import = std::function<absl::StatusOr<ImportedPackage>(const std::atomic<bool>& stop,
                                                             std::vector<std::string>& warnings)>;

/// Calls `import`. A signal stops it, and the warnings of Blender and of the importer are printed.
absl::StatusOr<ImportedPackage> import_with_warnings(const Import& import, Verbosity verbosity,
                                                     Process& process) {
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  std::vector<std::string> warnings;
  auto package = import(stop, warnings);
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

/// Returns INVALID_ARGUMENT if --shutter is given, because the option cannot change the shutter
/// that Blender writes.
absl::Status check_choices_for_blender(const std::string& scene, const SceneChoices& choices) {
  return choices.shutter ? absl::InvalidArgumentError(absl::StrCat(
                               scene, ": the shutter is that of the file; omit --shutter"))
                         : absl::OkStatus();
}

/// Imports a scene that Blender has written.
absl::StatusOr<ImportedPackage> import_from_blender(const BlendScene& blend,
                                                    const SceneChoices& choices,
                                                    const ImportLimits& limits,
                                                    std::vector<std::string>& warnings) {
  warnings = blend.warnings;
  SceneChoices remaining = choices;  // Blender has set the frame
  remaining.frame.reset();
  remaining.fps.reset();
  return import_in_process(blend.scene, limits, remaining);
}

}  // namespace

absl::StatusOr<ImportedPackage> import_any_scene(const std::string& scene,
                                                 const SceneChoices& choices,
                                                 const std::atomic<bool>& stop,
                                                 std::vector<std::string>& warnings) {
  ImportLimits limits;
  limits.stop = &stop;
  if (!is_blend_file(scene)) {
    return import_in_process(scene, limits, choices);
  }
  RETURN_IF_ERROR(check_choices_for_blender(scene, choices));
  ASSIGN_OR_RETURN(const std::unique_ptr<BlendScene> blend,
                   scene_of_blend_file(scene, stop, choices.frame));
  return import_from_blender(*blend, choices, limits, warnings);
}

absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process, const SceneChoices& choices) {
  return import_with_warnings(
      [&](const std::atomic<bool>& stop, std::vector<std::string>& warnings) {
        return import_any_scene(scene, choices, stop, warnings);
      },
      verbosity, process);
}

absl::StatusOr<DecodedScene> decode_scene_file(const std::string& scene, Verbosity verbosity,
                                               Process& process, const SceneChoices& choices) {
  // Without a listener, a signal would end the program before the temporary folder of the package
  // is removed.
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  ASSIGN_OR_RETURN(ImportedPackage package, import_scene_file(scene, verbosity, process, choices));
  ASSIGN_OR_RETURN(SceneDescription description,
                   decode_package(package.manifest(), package.blobs()));
  if (stop) {
    return absl::CancelledError("interrupted");
  }
  return DecodedScene{package.manifest(), package.info(), std::move(description)};
}

absl::StatusOr<ImportedPackage> FrameImporter::import(std::int64_t frame,
                                                      const std::atomic<bool>& stop,
                                                      std::vector<std::string>& warnings) {
  if (is_blend_file(scene_)) {
    RETURN_IF_ERROR(check_choices_for_blender(scene_, choices_));
    if (blender_ == nullptr) {
      ASSIGN_OR_RETURN(blender_, BlendSession::start(scene_));
    }
    ASSIGN_OR_RETURN(const BlendScene* blend, blender_->at(frame, stop));
    ImportLimits limits;
    limits.stop = &stop;
    return import_from_blender(*blend, choices_, limits, warnings);
  }
  if (session_ == nullptr) {
    ASSIGN_OR_RETURN(session_, ImportSession::start(scene_, {}, choices_));
  }
  return session_->import(frame, &stop);
}

absl::StatusOr<ImportedPackage> FrameImporter::import(std::int64_t frame, Verbosity verbosity,
                                                      Process& process) {
  return import_with_warnings(
      [&](const std::atomic<bool>& stop, std::vector<std::string>& warnings) {
        return import(frame, stop, warnings);
      },
      verbosity, process);
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
