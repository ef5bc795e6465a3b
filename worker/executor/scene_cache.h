#pragma once

// Cache of the last two scenes that are ready to render, so that a worker that alternates between
// two jobs does not rebuild their BVHs for every band.

#include <atomic>
#include <functional>
#include <list>
#include <memory>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/base/mutex.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::worker {

/// Callback with the progress of preparation: a number that only increases (bytes fetched, steps
/// done).
using Prepared = std::function<void(std::uint64_t)>;

/// Builds the scene of the package with this manifest (PackageLoader). Returns CANCELLED soon after
/// `stop` is set.
using LoadScene = std::function<absl::StatusOr<std::shared_ptr<const Scene>>(
    const wire::Digest& manifest, const std::atomic<bool>& stop, const Prepared& prepared)>;

class SceneCache {
 public:
  explicit SceneCache(LoadScene load) : load_(std::move(load)) {}
  /// Returns the scene, loading it if necessary. One scene is loaded at a time, because loading
  /// uses all cores; other callers wait. If LoadScene fails, returns its error. The next call then
  /// loads the scene again.
  absl::StatusOr<std::shared_ptr<const Scene>> get(const wire::Digest& manifest,
                                                   const std::atomic<bool>& stop,
                                                   const Prepared& prepared) EXCLUDES(mutex_);

 private:
  struct Entry {
    wire::Digest manifest;
    std::shared_ptr<const Scene> scene;
  };
  const LoadScene load_;
  Mutex mutex_;
  std::list<Entry> entries_ GUARDED_BY(mutex_);  ///< most recently used first
};

}  // namespace bandsaw::worker
