// Keeps the newest fields. A thread that needs a field which another thread is training waits for
// it.

#include "renderlib/guiding/guiding_cache.h"

#include <utility>

namespace bandsaw {

GuidingCache::Trained GuidingCache::get(const GuidingKey& key, absl::FunctionRef<Trained()> make) {
  const MutexLock lock(mutex_);
  for (const Entry& entry : entries_) {
    if (entry.key == key) {
      return entry.trained;
    }
  }
  Trained trained = make();
  if (trained != nullptr) {
    if (entries_.size() == kMaxFields) {
      entries_.pop_front();
    }
    entries_.push_back({key, trained});
  }
  return trained;
}

GuidingCache::Map GuidingCache::get_map(const PhotonMapKey& key, absl::FunctionRef<Map()> make) {
  const MutexLock lock(mutex_);
  for (const MapEntry& entry : maps_) {
    if (entry.key == key) {
      return entry.map;
    }
  }
  Map map = make();
  if (map != nullptr) {
    maps_.push_back({key, map});
    map_bytes_ += map->map.bytes();
    while (maps_.size() > 1 && map_bytes_ > kMaxMapBytes) {
      map_bytes_ -= maps_.front().map->map.bytes();
      maps_.pop_front();
    }
  }
  return map;
}

}  // namespace bandsaw
