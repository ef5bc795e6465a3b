#pragma once

// Makes a job of a scene file that the dashboard has received or that belongs to the gallery. The
// file is read by the importer, a separate process with few rights. The function that runs the
// importer is passed in (ImportScene), because only the command `serve` knows where the importer
// is.

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "proto/web.pb.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

/// A scene package (proto/package.proto) whose blobs are in the engine's store.
struct SceneOnFarm {
  DigestHex manifest;  ///< identifies the package
  PackageInfo info;
};

/// Imports the scene file `path` and stores its package. If `path` is a zip file, `inside` names
/// the scene file in it; empty: the only one. The call blocks, and fails with CANCELLED soon after
/// `stop` becomes true. Other errors are those of the importer, whose messages name the file, and
/// those of the store.
using ImportScene = std::function<absl::StatusOr<SceneOnFarm>(
    const std::string& path, const std::string& inside, const std::atomic<bool>& stop)>;

/// Parameters of a job that renders a scene.
struct SceneRequest {
  std::string request_id;   ///< as in farm.SubmitRequest; empty: a random one
  std::string title = {};   ///< the job's name; empty: the scene's name
  std::uint32_t width = 0;  ///< pixels; 0: the scene's own; the height keeps the aspect ratio
  StopRule stop = StopAtSamples{64};
  std::string inside = {};  ///< name of the scene in a zip file; empty: the only one
};

/// Thread-safe.
class Scenes {
 public:
  /// Maximum number of files that are imported at the same time; more are refused.
  static constexpr int kAtOnce = 2;

  Scenes(Engine& engine, ImportScene import_scene)
      : engine_(engine), import_scene_(std::move(import_scene)) {}

  /// Imports the scene and submits its job. Returns the job and the importer's warnings. Returns
  /// the errors of ImportScene and Engine::submit. UNAVAILABLE: kAtOnce other scenes are being
  /// imported.
  absl::StatusOr<web::Submitted> submit(const std::string& path, const SceneRequest& wanted);
  /// Stops current imports and refuses later ones.
  void stop() { stop_ = true; }

 private:
  Engine& engine_;
  const ImportScene import_scene_;
  std::atomic<bool> stop_{false};
  std::atomic<int> reading_{0};
};

}  // namespace bandsaw::coordinator
