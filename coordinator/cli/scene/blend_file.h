#pragma once

// Converts a .blend file to a scene file. The installed Blender is run without a window, with a
// script (deploy/blender) that writes what Blender would render: a scene file and the files that
// the scene file names.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/store/scratch_folder.h"

namespace bandsaw::coordinator {

class Coprocess;

/// Returns true for names that end in .blend.
bool is_blend_file(const std::string& path);

/// A scene that Blender has written, in a temporary folder that is removed with this object.
class BlendScene {
 public:
  /// `name`: the name of the scene, without a suffix.
  BlendScene(std::unique_ptr<const ScratchFolder> folder, const std::string& name)
      : scene(folder->path() + "/" + name + ".json"), folder_(std::move(folder)) {}

  std::string scene;                  ///< the path of the scene file in the folder
  std::vector<std::string> warnings;  ///< sentences about what looks different in Blender

  /// Returns the path of the temporary folder.
  const std::string& folder() const { return folder_->path(); }

 private:
  std::unique_ptr<const ScratchFolder> folder_;
};

/// Runs Blender on the file at `path` and returns the scene at a frame. `frame`: the number of the
/// frame; std::nullopt: the frame that is saved in the file. Scripts in the file are not run.
/// Blender runs with all rights of the user, unlike the importer, a confined process that reads the
/// scene files. NOT_FOUND: there is no such file. INVALID_ARGUMENT: Blender cannot read or render
/// the file. FAILED_PRECONDITION: Blender is not installed. CANCELLED: `stop` was set.
/// DEADLINE_EXCEEDED: Blender took more than ten minutes.
absl::StatusOr<std::unique_ptr<BlendScene>> scene_of_blend_file(
    const std::string& path, const std::atomic<bool>& stop,
    std::optional<std::int64_t> frame = std::nullopt);

/// One process of Blender that writes the scenes of many frames of a .blend file. It reads the file
/// only once.
class BlendSession {
 public:
  /// Starts Blender. Errors as scene_of_blend_file.
  static absl::StatusOr<std::unique_ptr<BlendSession>> start(const std::string& path);
  ~BlendSession();
  BlendSession(const BlendSession&) = delete;
  BlendSession& operator=(const BlendSession&) = delete;

  /// Writes the scene at a frame and returns it. The scene belongs to this object and replaces the
  /// scene of the frame before. Errors as scene_of_blend_file; after an error at() MUST NOT be
  /// called again.
  absl::StatusOr<const BlendScene*> at(std::int64_t frame, const std::atomic<bool>& stop);

 private:
  BlendSession(std::string path, std::unique_ptr<BlendScene> scene,
               std::unique_ptr<Coprocess> blender);

  const std::string path_;
  const std::unique_ptr<BlendScene> scene_;
  const std::unique_ptr<Coprocess> blender_;
};

}  // namespace bandsaw::coordinator
