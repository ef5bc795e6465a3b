// Keeps the last two scenes, the most recently used first. The older one is dropped before another
// scene is loaded.

#include "worker/executor/scene_cache.h"

#include "renderlib/base/status_macros.h"

namespace bandsaw::worker {
namespace {

constexpr std::size_t kScenes = 2;

}  // namespace

absl::StatusOr<std::shared_ptr<const Scene>> SceneCache::get(const wire::Digest& manifest,
                                                             const std::atomic<bool>& stop,
                                                             const Prepared& prepared) {
  MutexLock lock(mutex_);
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    if (entry->manifest == manifest) {
      entries_.splice(entries_.begin(), entries_, entry);
      return entries_.front().scene;
    }
  }
  // The oldest scene is dropped before the next scene is built, so that memory need not hold the
  // oldest and the next scene at the same time.
  while (entries_.size() >= kScenes) {
    entries_.pop_back();
  }
  ASSIGN_OR_RETURN(std::shared_ptr<const Scene> scene, load_(manifest, stop, prepared));
  entries_.push_front({.manifest = manifest, .scene = scene});
  return scene;
}

}  // namespace bandsaw::worker
