#pragma once

// From a scene file to a job. The file is read by the confined importer, as everywhere; how is
// given from outside (ImportScene), because the programs lie with the command.

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

/// A package whose blobs are in the engine's store.
struct SceneOnFarm {
  DigestHex manifest;
  PackageInfo info;
};

/// Imports a scene file and stores its package. Blocks; CANCELLED soon after `stop` becomes true.
/// Errors of the importer, naming the file, and of the store.
using ImportScene = std::function<absl::StatusOr<SceneOnFarm>(const std::string& path,
                                                              const std::atomic<bool>& stop)>;

/// What is wanted of a scene.
struct SceneWish {
  std::string request_id;   ///< as in farm.SubmitRequest; empty: a new one
  std::uint32_t width = 0;  ///< pixels; 0: the scene's own; the height keeps the shape
  StopRule stop = StopAtSamples{64};
};

/// Thread-safe.
class Scenes {
 public:
  /// So many files are read at the same time; more are refused.
  static constexpr int kAtOnce = 2;

  Scenes(Engine& engine, ImportScene import_scene)
      : engine_(engine), import_scene_(std::move(import_scene)) {}

  /// Errors of ImportScene and Engine::submit; RESOURCE_EXHAUSTED: busy with others.
  absl::StatusOr<web::Submitted> submit(const std::string& path, const SceneWish& wanted);
  /// Ends what is being read; what comes later is refused.
  void stop() { stop_ = true; }

 private:
  Engine& engine_;
  const ImportScene import_scene_;
  std::atomic<bool> stop_{false};
  std::atomic<int> reading_{0};
};

}  // namespace bandsaw::coordinator
