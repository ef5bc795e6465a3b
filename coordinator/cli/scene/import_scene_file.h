#pragma once

// Imports a scene file, for submit and render.

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

/// Imports a scene file, a model, a foreign scene, or a .blend file, whose own warnings are added.
/// Errors as import_in_process and scene_of_blend_file.
absl::StatusOr<ImportedPackage> import_any_scene(const std::string& scene,
                                                 const SceneChoices& choices,
                                                 const std::atomic<bool>& stop,
                                                 std::vector<std::string>& warnings);

/// Imports in the confined process; a signal cancels it. For a .blend file, Blender makes the scene
/// first. Prints the warnings unless quiet. Errors as import_in_process and scene_of_blend_file.
absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process,
                                                  const SceneChoices& choices = {});

/// Imports the frames of one scene, one after the other. The files of a scene are read only once.
/// For a .blend file, one Blender process reads the file once and writes a scene for each frame.
class FrameImporter {
 public:
  /// Reads nothing yet. `choices.frame` is ignored.
  FrameImporter(std::string scene, SceneChoices choices)
      : scene_(std::move(scene)), choices_(std::move(choices)) {}

  /// Imports a frame; the package of the frame before is not valid any more. Errors as
  /// import_any_scene; no other frame can be imported then.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, const std::atomic<bool>& stop,
                                         std::vector<std::string>& warnings);
  /// Imports a frame in the same way, and reports progress and warnings to the user as
  /// import_scene_file does.
  absl::StatusOr<ImportedPackage> import(std::int64_t frame, Verbosity verbosity, Process& process);

 private:
  const std::string scene_;
  const SceneChoices choices_;
  std::unique_ptr<ImportSession> session_;
  std::unique_ptr<BlendSession> blender_;  ///< set for a .blend file
};

/// Prints the importer's warnings unless quiet.
void print_warnings(const std::vector<std::string>& warnings, Verbosity verbosity,
                    Process& process);

/// Maps an import error to an exit code: a scene that cannot be read is wrong input for whatever
/// reason; an interrupt and a broken installation are not.
ExitCode import_exit_code(const absl::Status& status);

}  // namespace bandsaw::coordinator
