#pragma once

// Imports a scene file, for submit and render.

#include <atomic>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/import_process.h"

namespace bandsaw::coordinator {

/// Imports a scene file, a model, a foreign scene, or a .blend file, whose own warnings are added.
/// Errors as import_in_process and scene_of_blend_file.
absl::StatusOr<ImportedPackage> import_any_scene(const std::string& scene,
                                                 const SceneChoices& choices,
                                                 const std::atomic<bool>& stop,
                                                 std::vector<std::string>& warnings);

/// Imports in the confined process; a signal cancels it. Of a .blend file Blender makes the scene
/// first. Prints the warnings unless quiet. Errors as import_in_process and scene_of_blend_file.
absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process,
                                                  const SceneChoices& choices = {});

/// Prints the importer's warnings unless quiet.
void print_warnings(const std::vector<std::string>& warnings, Verbosity verbosity,
                    Process& process);

/// Maps an import error to an exit code: a scene that cannot be read is wrong input for whatever
/// reason; an interrupt and a broken installation are not.
ExitCode import_exit_code(const absl::Status& status);

}  // namespace bandsaw::coordinator
