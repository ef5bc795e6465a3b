#pragma once

// The guiding fields of a scene (guiding_field.h), each trained when it is first used.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "renderlib/base/mutex.h"
#include "renderlib/guiding/guiding_field.h"

namespace bandsaw {

/// The field of a scene depends on the shape of the image and the length of the paths. It does not
/// depend on the seed: images of all seeds use the same field.
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
  std::uint64_t rays = 0;     ///< rays of both
};

class GuidingCache {
 public:
  using Trained = std::shared_ptr<const TrainedGuiding>;

  /// Returns the field of `key`. If it is not kept yet, calls `make`; other threads that call get()
  /// wait meanwhile. If `make` returns nullptr (it was stopped), returns that and keeps nothing.
  Trained get(const GuidingKey& key, absl::FunctionRef<Trained()> make) EXCLUDES(mutex_);

 private:
  /// Number of fields that are kept. When there are more, the oldest one is dropped.
  static constexpr std::size_t kMaxFields = 4;
  struct Entry {
    GuidingKey key;
    Trained trained;
  };
  Mutex mutex_;
  std::deque<Entry> entries_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw
