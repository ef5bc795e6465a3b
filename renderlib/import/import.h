#pragma once

// The interface of this folder: converts a scene file, a foreign scene (a scene of pbrt or Mitsuba)
// or a model to the description that is encoded as a scene package. Only the confined process
// bandsaw-import (import/main.cpp) calls it, never the coordinator or a worker.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/draft/import_memory.h"
#include "renderlib/import/draft/imported_scene.h"
#include "renderlib/import/files/scene_folder.h"

namespace bandsaw {

/// A file that the user named in addition to the scene. It may lie outside of the scene's folder,
/// which the confined process cannot read, so its bytes are passed.
struct GivenFile {
  std::string name;  ///< for messages
  std::string bytes;
};

/// The choice of one frame of a sequence.
struct FrameChoice {
  double number = 0;          ///< its time is number / fps
  std::optional<double> fps;  ///< frames per second, [0.01, 10000]; absent: the scene's
  /// Share of the frame's time in which the shutter is open, [0, 1]; absent: the scene's shutter.
  std::optional<double> shutter;
};

/// Choices of the user in addition to the scene.
struct ImportChoices {
  std::optional<GivenFile> environment =
      {};                   ///< equirectangular image that replaces the scene's background
  std::string camera = {};  ///< name of a camera of the scene's models; empty: the scene's own
  std::map<std::string, std::string> parameters = {};  ///< parameters of a Mitsuba scene
  bool strict = false;                                 ///< a warning is an error
  std::optional<FrameChoice> frame = {};               ///< absent: the scene is imported at time 0
  /// Name of the animation of those models for which the scene file names none. If it is empty,
  /// each such model has its first animation if a frame is chosen, otherwise none.
  std::string animation = {};
  /// A folder that contains the folder of a Mitsuba scene. Files anywhere below it may be read. If
  /// it is empty, only files below the scene's own folder may be read.
  std::string folder = {};
};

/// Returns the folder below which the import reads. The errors are those of SceneFolder::around().
/// The error is also INVALID_ARGUMENT if `choices.folder` is set and `path` is not a scene of
/// Mitsuba.
absl::StatusOr<SceneFolder> folder_to_read(const std::string& path, const ImportChoices& choices);

/// Reads a scene file (*.textproto, *.json), a scene of pbrt-v4 (*.pbrt, *.pbrt.gz) or Mitsuba
/// (*.xml), or a single model. A model without a camera gets a camera that frames it, and a model
/// without a light source gets a default sky. Only files below the folder of `path` (for Mitsuba,
/// below `choices.folder` if it is set) are read. An invalid value is INVALID_ARGUMENT, for example
/// "cornell.textproto:12:3: shape[4].sphere.radius: must be > 0, is -1". A missing
/// file is NOT_FOUND, and a file outside of the folder is PERMISSION_DENIED, both with the file's
/// name. `memory` is passed to the imports of all frames of one scene. It keeps models, image
/// textures and the foreign scene from one import to the next, and the imported scenes share their
/// equal parts. If `memory` is nullptr, nothing is kept.
absl::StatusOr<ImportedScene> import_scene(const std::string& path,
                                           const ImportChoices& choices = {},
                                           ImportMemory* memory = nullptr);

/// A foreign scene or a model, converted to a scene file of Bandsaw, for `bandsaw import`.
struct SceneAsText {
  std::string text;                                ///< protobuf text format
  std::map<std::string, std::string> made_files;   ///< name in the scene -> bytes
  std::map<std::string, std::string> found_files;  ///< name below the folder -> real path
  std::vector<std::string> warnings;
};

/// Converts a scene of pbrt-v4 or Mitsuba, or a single model, to a scene file of Bandsaw. The
/// result is read as import_scene() reads it, so that the text is known to be valid. Ignores
/// `environment` and `camera` of the choices. Returns the errors of import_scene(), and
/// INVALID_ARGUMENT also if `path` is a scene file of Bandsaw already.
absl::StatusOr<SceneAsText> scene_as_text(const std::string& path,
                                          const ImportChoices& choices = {});

}  // namespace bandsaw
