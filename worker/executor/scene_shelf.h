#pragma once

// The scenes that are ready to render: the last two packages, so that a worker that goes to and fro
// between two jobs does not build its trees again for every band.

#include <atomic>
#include <functional>
#include <list>
#include <memory>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/base/mutex.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::worker {

/// Told how far preparation is: a number that only grows (bytes fetched, steps done).
using Prepared = std::function<void(std::uint64_t)>;

/// Makes a scene of the package with this manifest. CANCELLED soon after `stop` is set.
using LoadScene = std::function<absl::StatusOr<std::shared_ptr<const Scene>>(
    const wire::Digest& manifest, const std::atomic<bool>& stop, const Prepared& prepared)>;

class SceneShelf {
 public:
  explicit SceneShelf(LoadScene load) : load_(std::move(load)) {}
  /// One scene is loaded at a time, because loading uses all cores; who wants the same one waits
  /// for it. A failure is not kept.
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
  std::list<Entry> entries_ GUARDED_BY(mutex_);  ///< last used first
};

}  // namespace bandsaw::worker
