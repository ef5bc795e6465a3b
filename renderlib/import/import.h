#pragma once

// Scene files and models to a scene package. Runs in its own confined process (import/main.cpp);
// coordinator and workers never do this.

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/imported_scene.h"

namespace bandsaw {

/// A file that somebody named beside the scene: it may lie anywhere, so its bytes come with it.
struct GivenFile {
  std::string name;  ///< for messages
  std::string bytes;
};

/// What somebody chose beside the scene.
struct ImportChoices {
  std::optional<GivenFile> environment = {};  ///< equirectangular image, instead of its background
  std::string camera = {};  ///< the name of one of its models' cameras; empty: the scene's own
};

/// Reads a scene file (*.textproto, *.json) or a model alone (then framed under a default sky,
/// unless it brings cameras and lights). Files are read only below the folder of `path`.
/// INVALID_ARGUMENT: "cornell.textproto:12:3: shape[4].sphere.radius: must be > 0, is -1".
/// NOT_FOUND, PERMISSION_DENIED: naming the file.
absl::StatusOr<ImportedScene> import_scene(const std::string& path,
                                           const ImportChoices& choices = {});

}  // namespace bandsaw
