#pragma once

// Finds hits fast. The answer does not depend on the tree: boxes are conservative, the test of each
// primitive is one deterministic double-precision function, and the closest hit is the lowest (t,
// instance, primitive).

#include <cstddef>
#include <memory>

#include "renderlib/base/pool.h"
#include "renderlib/geometry/moving_bounds.h"
#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// What a ray is tested against.
enum class Tested {
  kOnItsWay,    ///< what lies in boxes that it meets
  kEverything,  ///< all there is, as without trees: the same hits, slowly
};

class Accel {
 public:
  /// `geometry` MUST outlive the result and not change. What moves is found by rays whose time is
  /// within `interval`.
  static Accel build(const Geometry& geometry, Pool& pool, const Interval& interval = {},
                     Tested tested = Tested::kOnItsWay);

  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;
  ~Accel();

  /// The closest hit, or one that is false.
  Hit closest(const Ray& ray) const;
  /// The closest hit beyond `after`, an earlier hit of the same ray, in the order (t, instance,
  /// primitive): surfaces in the same place are all met, one after the other.
  Hit closest_after(const Ray& ray, const Hit& after) const;
  /// Whether anything lies in (0, ray.t_max).
  bool occluded(const Ray& ray) const;

  /// Memory of the trees.
  std::size_t bytes() const;

 private:
  struct Trees;
  explicit Accel(std::unique_ptr<Trees> trees);
  std::unique_ptr<Trees> trees_;
};

}  // namespace bandsaw
