#pragma once

// The spaces in which media vary (scene/media.h). A medium moves with its boundary (the closed
// shape that it fills), so it varies in the space of the boundary's frame, a coordinate system that
// may move. If the boundary has no frame, the medium varies in world space. MediumSpaces maps
// points of the world to the space of a medium. A Scene holds one MediumSpaces.

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
