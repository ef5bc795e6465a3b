#pragma once

// The fields of path guiding of a scene, each made when it is first used.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "renderlib/base/mutex.h"
#include "renderlib/guiding/guiding_field.h"

namespace bandsaw {

/// The shape of the image and the length of the paths, on which the field of a scene depends. It
/// does not depend on the seed, so that no image is luckier than another.
struct GuidingKey {
  std::uint32_t width = 0;   ///< pixels
  std::uint32_t height = 0;  ///< pixels
  std::uint32_t max_depth = 0;
  friend bool operator==(const GuidingKey&, const GuidingKey&) = default;
};

struct TrainedGuiding {
  GuidingField field;
  std::uint64_t paths = 0;    ///< training paths from the camera
  std::uint64_t photons = 0;  ///< 0 if nothing in the scene casts caustics
  std::uint64_t rays = 0;     ///< of both
};

class GuidingCache {
 public:
  using Trained = std::shared_ptr<const TrainedGuiding>;

  /// Returns the field of `key`, which `make` makes if it is not there. Others that ask meanwhile
  /// wait. `make` returns nullptr if it was stopped; nothing is kept then.
  Trained get(const GuidingKey& key, absl::FunctionRef<Trained()> make) EXCLUDES(mutex_);

 private:
  /// Fields that are kept; the oldest one is dropped.
  static constexpr std::size_t kMostFields = 4;
  struct Entry {
    GuidingKey key;
    Trained trained;
  };
  Mutex mutex_;
  std::deque<Entry> entries_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw
