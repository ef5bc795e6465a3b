#pragma once

// Keeps the guiding fields (the directions from which light arrives, guiding_field.h) and the
// photon maps (photon_map.h) of a scene. A field or map is made when it is first used. Each Scene
// has one GuidingCache.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "absl/functional/function_ref.h"
#include "renderlib/base/mutex.h"
#include "renderlib/guiding/guiding_field.h"
#include "renderlib/guiding/photon_map.h"
#include "renderlib/guiding/portals.h"

namespace bandsaw {

struct PhotonSources;  // renderlib/integrate/photon_sources.h

/// The field of a scene depends on the width and height of the image and on the maximum depth of
/// the paths. It does not depend on the seed: images of all seeds use the same field.
struct GuidingKey {
  std::uint32_t width = 0;   ///< pixels
  std::uint32_t height = 0;  ///< pixels
  std::uint32_t max_depth = 0;
  /// If true, a field that does not repay its cost stays empty, and photon maps that do not repay
  /// their cost are not used.
  bool only_if_it_pays = false;
  friend bool operator==(const GuidingKey&, const GuidingKey&) = default;
};

/// A field and what its training cost.
struct TrainedGuiding {
  GuidingField field;
  /// Openings through which the background is sampled (integrate/find_portals.h); maybe none.
  Portals portals;
  std::uint64_t paths = 0;    ///< training paths from the camera
  std::uint64_t photons = 0;  ///< 0 if nothing in the scene casts caustics
  /// Rays of training paths, of photons, of pilots (short trials that show whether guiding and maps
  /// pay), and of the first photon map.
  std::uint64_t rays = 0;
  /// The surfaces at which the photons of maps start; null: no light comes from maps.
  std::shared_ptr<const PhotonSources> sources;
};

/// The parameters of photon maps, besides the scene and the sources.
struct PhotonMapKey {
  std::uint64_t seed = 0;
  std::uint32_t number = 0;   ///< maps of higher numbers have smaller disks of photons
  std::uint64_t photons = 0;  ///< number of photons that are started for caustics
  GuidingKey field = {};      ///< key of the field whose training decided on the sources
  friend bool operator==(const PhotonMapKey&, const PhotonMapKey&) = default;
};

/// The photon maps that a range of samples shares, and values that were measured while the maps
/// were made.
struct TracedMaps {
  PhotonMap caustics;  ///< empty if caustics are left to paths
  /// Number of equal parts of the shutter interval. A path is lit only by photons of the part in
  /// which it travels. It is 1 if nothing moves.
  std::uint32_t parts = 1;
  /// Light that receivers (surfaces whose sampled lobes are all wide) scattered
  /// (integrate/indirect_photons.h).
  PhotonMap indirect;
  /// In scene units. A path takes indirect light from `indirect` if its length since the last
  /// receiver is at least this distance. If `indirect` is empty, the distance is 0 and not used.
  double gather_distance = 0;
  /// Effective number of the points at which the photons of `indirect` start: the squared sum of
  /// the points' powers over the sum of the squared powers (Kish 1965, "Survey Sampling").
  double effective_origins = 0;
  /// Mean solid angle of the lamps in steradians, weighted by power, as seen from the points where
  /// photons of caustics start.
  double lamp_angle = 0;
  std::uint64_t rays = 0;  ///< rays that were traced to make the maps

  std::size_t bytes() const { return caustics.bytes() + indirect.bytes(); }
};

/// The fields and maps of one scene. All functions may be called from any thread.
class GuidingCache {
 public:
  using Trained = std::shared_ptr<const TrainedGuiding>;
  using Maps = std::shared_ptr<const TracedMaps>;

  /// Returns the field of `key`. If it is not kept yet, calls `make` and keeps its result. Other
  /// threads that call a function of this object wait meanwhile. If `make` returns nullptr (it was
  /// stopped), returns nullptr and keeps nothing.
  Trained get(const GuidingKey& key, absl::FunctionRef<Trained()> make) EXCLUDES(mutex_);
  /// Forgets all fields and maps, so that the next image makes new ones. Used for measurements.
  void clear() EXCLUDES(mutex_);
  /// Does the same as get() for the photon maps of `key`.
  Maps get_maps(const PhotonMapKey& key, absl::FunctionRef<Maps()> make) EXCLUDES(mutex_);

 private:
  /// Number of fields that are kept. When there are more, the oldest one is dropped.
  static constexpr std::size_t kMaxFields = 4;
  /// Maximum memory of the maps that are kept, in bytes. When they take more, the oldest maps are
  /// dropped. The newest map is always kept.
  static constexpr std::size_t kMaxMapBytes = std::size_t{512} << 20;
  struct FieldEntry {
    GuidingKey key;
    Trained made;
  };
  struct MapEntry {
    PhotonMapKey key;
    Maps made;
  };
  Mutex mutex_;
  std::deque<FieldEntry> fields_ GUARDED_BY(mutex_);
  std::deque<MapEntry> maps_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw
