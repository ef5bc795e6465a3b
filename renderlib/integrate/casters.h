#pragma once

// Surfaces that cast caustics: mirrors, glass, and metals of little roughness. Mixtures are left
// out.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/integrate/surface_sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The casters of a scene, at which the photons of caustics start (photon_start.h).
class Casters {
 public:
  /// Collects the casters of the scene, which MUST outlive this object. If the casters have more
  /// than 2^18 primitives, takes only every n-th of them, with the smallest sufficient n.
  explicit Casters(const Scene& scene);
  /// Returns an object without casters, for a scene whose caustics are left to paths.
  static Casters none(const Scene& scene);

  bool empty() const { return materials_.empty(); }
  /// Returns true if every point of every caster can be sampled.
  bool complete() const { return complete_; }
  /// Returns true if the primitive moves while the shutter is open. Such surfaces may be casters,
  /// but they are no receivers.
  bool moves(PrimitiveId id) const {
    return !moving_.empty() && id.instance > 0 && moving_[id.instance - 1];
  }
  /// Returns true if surfaces of this material are casters; false for mixtures.
  bool casts(MaterialId id) const { return casting_[index_of(id)]; }

  /// Returns a random point of a caster at this time. `material` chooses a material, each with the
  /// same probability. Then `primitive` chooses a primitive of this material in proportion to its
  /// area, and `u` and `v` choose a place on it. These numbers are all in [0, 1). There MUST be
  /// casters. Returns std::nullopt if the point or its pdf is not finite.
  std::optional<SurfaceSample> sample(double material, double primitive, double u, double v,
                                      double time) const;

 private:
  /// Makes an object without casters for a scene with this number of materials.
  Casters(const Scene& scene, std::size_t materials) : scene_(scene), casting_(materials) {}

  const Scene& scene_;
  std::vector<bool> casting_;  ///< for each material, true if its surfaces are casters
  std::vector<bool> moving_;   ///< for each instance, true if it moves; empty if none does
  bool complete_ = true;
  std::vector<SurfaceSampler> materials_;  ///< the primitives of each material that casts
};

}  // namespace bandsaw
