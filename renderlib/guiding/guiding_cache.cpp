// Keeps the newest guiding fields and photon maps of a scene. While one thread makes a field or
// maps, it holds the mutex, and all other callers wait.

#include "renderlib/guiding/guiding_cache.h"

#include <utility>

namespace bandsaw {
namespace {

/// Returns the field or the maps that are kept for `key`. If there are none, calls `make`, and
/// keeps the result unless it is nullptr.
template <class Entry, class Key, class Made>
Made get_or_make(std::deque<Entry>& entries, const Key& key, absl::FunctionRef<Made()> make) {
  for (const Entry& entry : entries) {
    if (entry.key == key) {
      return entry.made;
    }
  }
  Made made = make();
  if (made != nullptr) {
    entries.push_back({key, made});
  }
  return made;
}

}  // namespace

GuidingCache::Trained GuidingCache::get(const GuidingKey& key, absl::FunctionRef<Trained()> make) {
  const MutexLock lock(mutex_);
  Trained trained = get_or_make(fields_, key, make);
  if (fields_.size() > kMaxFields) {
    fields_.pop_front();
  }
  return trained;
}

void GuidingCache::clear() {
  const MutexLock lock(mutex_);
  fields_.clear();
  maps_.clear();
}

GuidingCache::Maps GuidingCache::get_maps(const PhotonMapKey& key, absl::FunctionRef<Maps()> make) {
  const MutexLock lock(mutex_);
  Maps maps = get_or_make(maps_, key, make);
  std::size_t bytes = 0;
  for (const MapEntry& entry : maps_) {
    bytes += entry.made->bytes();
  }
  while (maps_.size() > 1 && bytes > kMaxMapBytes) {
    bytes -= maps_.front().made->bytes();
    maps_.pop_front();
  }
  return maps;
}

}  // namespace bandsaw
