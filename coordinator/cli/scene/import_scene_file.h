#pragma once

// A scene file to a package, for submit and render alike.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/import_process.h"

namespace bandsaw::coordinator {

/// Imports in the confined process; a signal stops it. The importer's warnings are said unless
/// quiet. Errors as of import_in_process.
absl::StatusOr<ImportedPackage> import_scene_file(const std::string& scene, Verbosity verbosity,
                                                  Process& process,
                                                  const SceneChoices& choices = {});

/// A scene that cannot be read is wrong input, whatever the reason; an interrupt and a broken
/// installation are not.
ExitCode import_exit_code(const absl::Status& status);

}  // namespace bandsaw::coordinator
