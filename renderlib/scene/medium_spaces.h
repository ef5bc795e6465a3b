#pragma once

// The spaces in which media vary (scene/media.h). A medium varies in the space of the frame with
// which its boundary moves; without a frame that is the space of the world. MediumSpaces maps
// points of the world to this space. A Scene holds one MediumSpaces.

#include <cstdint>
#include <vector>

#include "renderlib/geometry/shapes.h"

namespace bandsaw {

class MediumSpaces {
 public:
  MediumSpaces() = default;
  /// Stores the frames of all boundaries, before static ones lose them (static_instances.h).
  explicit MediumSpaces(const Geometry& boundaries);

  /// Computes the maps of static boundaries from their original frames at `time`.
  void prepare(const Geometry& boundaries, double time);

  /// Returns the map from the world to the space of the medium in a boundary. `boundary` is
  /// Hit::id.instance, which is 0 for loose spheres. prepare() MUST have been called, with the same
  /// geometry.
  Transform to_medium(const Geometry& boundaries, std::uint32_t boundary, double time) const;

 private:
  std::vector<FrameId> frames_;   ///< the original frame of each instance
  std::vector<Transform> still_;  ///< the map of each static instance; unused for moving instances
};

}  // namespace bandsaw
