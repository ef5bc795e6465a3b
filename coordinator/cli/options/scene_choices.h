#pragma once

// The choices about a scene that the command line offers; the importer (cli/scene/import_process.h)
// applies them.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Choices of the user that override the scene. An empty or unset field: as in the scene.
struct SceneChoices {
  std::string environment = {};  ///< image file that becomes the background; may be in any folder
  std::string camera = {};       ///< name of a camera of one of the scene's models
  /// Parameters of a Mitsuba scene, each "name=value".
  std::vector<std::string> parameters = {};
  bool strict = false;  ///< a warning of the import is an error
  /// For a Mitsuba scene: a folder that contains the scene's folder and all files of the scene.
  /// Empty: the scene's folder.
  std::string folder = {};
  /// Name of the scene in a zip file. Empty: import_in_process() searches the zip file for its only
  /// scene.
  std::string inside = {};
  std::optional<std::int64_t> frame = {};  ///< number of a frame; its time is frame / fps
  std::optional<double> fps = {};          ///< frames per second, [0.01, 10000]
  /// Share of a frame's time in which the shutter is open, [0, 1]; absent: the scene's shutter.
  std::optional<double> shutter = {};
  std::string animation = {};  ///< name of an animation of the scene's models
};

}  // namespace bandsaw::coordinator
