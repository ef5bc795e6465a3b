#pragma once

// Surfaces that cast caustics: mirrors, glass, and metals of little roughness. Mixtures are left
// out.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/geometry/surface.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// A random point on a caster.
struct CasterSample {
  SurfacePoint point;
  double pdf = 0;  ///< by area, > 0
};

/// The casters of a scene, at which the photons of caustics start (photon_start.h).
class Casters {
 public:
  /// Collects the casters of the scene, which MUST outlive this object. If there are more than 2^18
  /// primitives, takes only every second, third, … of them.
  explicit Casters(const Scene& scene);

  bool empty() const { return materials_.empty(); }
  /// Returns true if every point of every caster can be sampled.
  bool complete() const { return complete_; }
  /// Returns true if surfaces of this material are casters; false for mixtures.
  bool casts(MaterialId id) const { return casting_[index_of(id)]; }

  /// Returns a point at this time: first a material is chosen, each with the same probability, then
  /// a primitive by its area, then a place on it. All numbers are in [0, 1). There MUST be casters.
  /// Returns std::nullopt if the point or its pdf is not finite (a primitive without area).
  std::optional<CasterSample> sample(double material, double primitive, double u, double v,
                                     double time) const;

 private:
  struct Primitive {
    PrimitiveId id;
    double area_up_to = 0;  ///< sum of the areas of the material's primitives up to this one
  };
  struct OfMaterial {
    MaterialId material;
    std::vector<Primitive> primitives;
  };

  const Scene& scene_;
  std::vector<bool> casting_;  ///< for each material
  bool complete_ = true;
  std::vector<OfMaterial> materials_;
};

}  // namespace bandsaw
