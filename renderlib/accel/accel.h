#pragma once

// Ray intersection queries over all geometry, accelerated by BVHs. The answers do not depend on the
// trees: boxes are conservative, the test of each primitive is one deterministic double-precision
// function, and the closest hit is the lowest (t, instance, primitive).

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

class Accel {
 public:
  /// Builds the BVHs. `geometry` MUST outlive the result and not change. Moving instances are only
  /// found by rays whose time is within Geometry::shutter. `earlier`: the BVHs of other geometries,
  /// which MUST NOT be of kBruteForce; BVHs of meshes that `geometry` shares with one of them are
  /// shared as well. kBruteForce shares none.
  static Accel build(const Geometry& geometry, Pool& pool, Traversal traversal = Traversal::kBvh,
                     absl::Span<const Accel* const> earlier = {});

  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;
  ~Accel();

  /// Returns the closest hit; false (as a bool) if there is none.
  Hit closest(const Ray& ray) const;
  /// Returns the closest hit beyond `after`, an earlier hit of the same ray, in the order (t,
  /// instance, primitive). So coincident surfaces are all returned, one after the other.
  Hit closest_after(const Ray& ray, const Hit& after) const;
  /// Returns true if anything lies in (0, ray.t_max).
  bool occluded(const Ray& ray) const;

  /// Returns the memory of the trees in bytes.
  std::size_t bytes() const;

 private:
  struct Trees;
  explicit Accel(std::unique_ptr<Trees> trees);
  std::unique_ptr<Trees> trees_;
};

}  // namespace bandsaw
