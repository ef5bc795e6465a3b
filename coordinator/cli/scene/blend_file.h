#pragma once

// Converts a .blend file to a scene file: runs the installed Blender without a window, with a
// script that writes what Blender would render as a scene file and the files that it names
// (deploy/blender).

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

class Coprocess;

/// Returns true for names that end in .blend.
bool is_blend_file(const std::string& path);

/// A scene that Blender has written, in a temporary folder that is removed with this object.
class BlendScene {
 public:
  BlendScene(std::string folder, std::string scene_path)
      : scene(std::move(scene_path)), folder_(std::move(folder)) {}
  ~BlendScene();
  BlendScene(const BlendScene&) = delete;
  BlendScene& operator=(const BlendScene&) = delete;

  std::string scene;                  ///< the path of the scene file
  std::vector<std::string> warnings;  ///< sentences about what looks different in Blender

  const std::string& folder() const { return folder_; }

 private:
  std::string folder_;
};

/// Runs Blender on the file, at this frame or at the one that is saved in it; scripts in the file
/// are not run. Unlike the importer, Blender runs with the user's rights. NOT_FOUND: no such file.
/// INVALID_ARGUMENT: Blender cannot read or render it. FAILED_PRECONDITION: Blender is not
/// installed. CANCELLED: `stop`. DEADLINE_EXCEEDED: it took more than ten minutes.
absl::StatusOr<std::unique_ptr<BlendScene>> scene_of_blend_file(
    const std::string& path, const std::atomic<bool>& stop,
    std::optional<std::int64_t> frame = std::nullopt);

/// One Blender that writes a .blend file at many frames: it reads the file once.
class BlendSession {
 public:
  /// Starts Blender. Errors as scene_of_blend_file.
  static absl::StatusOr<std::unique_ptr<BlendSession>> start(const std::string& path);
  ~BlendSession();
  BlendSession(const BlendSession&) = delete;
  BlendSession& operator=(const BlendSession&) = delete;

  /// Writes the scene at a frame, in place of the one before. Errors as scene_of_blend_file; the
  /// session is over then.
  absl::StatusOr<const BlendScene*> at(std::int64_t frame, const std::atomic<bool>& stop);

 private:
  BlendSession(std::string path, std::unique_ptr<BlendScene> scene,
               std::unique_ptr<Coprocess> blender);

  const std::string path_;
  const std::unique_ptr<BlendScene> scene_;
  const std::unique_ptr<Coprocess> blender_;
};

}  // namespace bandsaw::coordinator
