#pragma once

// Random points on surfaces, at which photons start (photon_start.h and indirect_photons.h). The
// points are uniform by area, except on ellipsoids.

#include <cstddef>
#include <optional>
#include <vector>

#include "renderlib/geometry/placement.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// A random point on a surface.
struct SurfaceSample {
  SurfacePoint point;
  double pdf = 0;  ///< by area, > 0
};

/// Samples points on a list of primitives.
class SurfaceSampler {
 public:
  /// Appends a primitive of the scene. Its area is computed for the middle of the shutter interval.
  /// If this area or the sum of all areas is not finite, leaves the primitive out and returns
  /// false. A primitive without area is left out as well, but then add() returns true.
  bool add(const Scene& scene, PrimitiveId id);

  bool empty() const { return primitives_.empty(); }

  /// Returns a random point of one of the primitives at this time. `primitive` chooses a primitive
  /// in proportion to its area, then `u` and `v` choose a place on it. These numbers are all in
  /// [0, 1). There MUST be primitives, and all of them MUST be of this scene. Returns std::nullopt
  /// if the point or its pdf is not finite.
  std::optional<SurfaceSample> sample(const Scene& scene, double primitive, double u, double v,
                                      double time) const;

 private:
  struct Primitive {
    PrimitiveId id;
    double area_up_to = 0;  ///< sum of the areas of the primitives up to this one
  };
  std::vector<Primitive> primitives_;
};

}  // namespace bandsaw
