#pragma once

// Ray intersection queries over all geometry, accelerated by BVHs. The answers do not depend on the
// trees: no box test rejects a box that contains a hit, the test of each primitive is one
// deterministic double-precision function, and the closest hit is the lowest (t, instance,
// primitive).

#include <cstddef>
#include <memory>

#include "absl/types/span.h"
#include "renderlib/base/pool.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Selects how a ray finds its primitives.
enum class Traversal {
  kBvh,         ///< tests the primitives in boxes that the ray enters
  kBruteForce,  ///< tests all primitives: the same hits, slowly; for comparison
};

/// The BVHs of one Geometry. A Scene has one Accel, and integrate/ traces rays through it.
class Accel {
 public:
  /// Builds the BVHs. `geometry` MUST outlive the result and not change. Moving instances are only
  /// found by rays whose time is within Geometry::shutter. `earlier` are the BVHs of other
  /// geometries, none of them built with kBruteForce. If one of those geometries shares a mesh with
  /// `geometry`, the BVH of the mesh is shared as well and not built again. A result of kBruteForce
  /// shares nothing.
  static Accel build(const Geometry& geometry, Pool& pool, Traversal traversal = Traversal::kBvh,
                     absl::Span<const Accel* const> earlier = {});

  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;
  ~Accel();

  /// Returns the closest hit. If there is none, the returned Hit converts to false.
  Hit closest(const Ray& ray) const;
  /// Returns the closest hit beyond `after`, a hit that an earlier call returned for the same ray.
  /// Hits are ordered by (t, instance, primitive), so repeated calls also return surfaces that
  /// coincide, one after the other.
  Hit closest_after(const Ray& ray, const Hit& after) const;
  /// Returns true if the ray hits anything at a t in (0, ray.t_max).
  bool occluded(const Ray& ray) const;

  /// Returns the memory of the trees in bytes.
  std::size_t bytes() const;

 private:
  struct Trees;
  explicit Accel(std::unique_ptr<Trees> trees);
  std::unique_ptr<Trees> trees_;
};

}  // namespace bandsaw
