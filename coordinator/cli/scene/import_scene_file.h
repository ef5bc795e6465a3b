#pragma once

// Imports what a user names as a scene, for `submit`, `render`, `study` and `info`: a scene file, a
// scene of pbrt or Mitsuba, a model, or a .blend file.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/blend_file.h"
#include "coordinator/cli/scene/import_process.h"

namespace bandsaw::coordinator {

/// Imports the scene. `warnings` is set to Blender's warnings for a .blend file, and unchanged
/// otherwise; the importer's warnings are in the package. Setting `stop` ends the import with
/// CANCELLED. Other errors: as import_in_process and scene_of_blend_file.
absl::StatusOr<ImportedPackage> import_any_scene(const std::string& scene,
                                                 const SceneChoices& choices,
                                                 const std::atomic<bool>& stop,
                                                 std::vector<std::string>& warnings);

/// Imports the scene for a command, as import_any_scene() does. A signal ends the import with
/// CANCELLED. All warnings are printed unless verbosity.quiet.
absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process,
                                                  const SceneChoices& choices = {});

/// A scene that is imported and decoded. The temporary folder of the import is already removed.
struct DecodedScene {
  std::string manifest;
  PackageInfo info;
  SceneDescription scene;
};

/// Imports a scene for a command as import_scene_file() does, and decodes it. CANCELLED: a signal
/// came; the temporary folder is removed. Other errors: those of import_scene_file() and of
/// decode_package().
absl::StatusOr<DecodedScene> decode_scene_file(const std::string& scene, Verbosity verbosity,
                                               Process& process, const SceneChoices& choices = {});

/// Imports the frames of one scene, one after the other. Its files are read only once: by one
/// importer (ImportSession) or, for a .blend file, by one Blender that writes a scene for each
/// frame.
class FrameImporter {
 public:
  /// Reads nothing yet. `choices.frame` is ignored.
  FrameImporter(std::string scene, SceneChoices choices)
      : scene_(std::move(scene)), choices_(std::move(choices)) {}

  /// Imports a frame; the package of the frame before becomes invalid. `stop`, `warnings` and
  /// errors as import_any_scene. After an error import() MUST NOT be called again.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, const std::atomic<bool>& stop,
                                         std::vector<std::string>& warnings);
  /// Imports a frame for a command. A signal ends the import with CANCELLED. All warnings are
  /// printed unless verbosity.quiet.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, Verbosity verbosity, Process& process);

 private:
  const std::string scene_;
  const SceneChoices choices_;
  std::unique_ptr<ImportSession> session_;  ///< nullptr: not started, or a .blend file
  std::unique_ptr<BlendSession> blender_;   ///< nullptr: not started, or no .blend file
};

/// Prints the warnings: as JSON events with --json, otherwise as text unless verbosity.quiet.
void print_warnings(const std::vector<std::string>& warnings, Verbosity verbosity,
                    Process& process);

/// Returns the exit code for an error of an import: kInterrupted for CANCELLED; kFailed for
/// FAILED_PRECONDITION and INTERNAL, which a broken installation causes; kWrong for all others,
/// because then the scene cannot be read.
ExitCode import_exit_code(const absl::Status& status);

}  // namespace bandsaw::coordinator
