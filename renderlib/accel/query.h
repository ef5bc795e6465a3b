#pragma once

// What is asked of the trees: the closest hit, or whether there is any. Both hear of every hit that
// the double tests find, in any order.

#include <vector>

#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

class ClosestQuery {
 public:
  static constexpr bool kAny = false;

  explicit ClosestQuery(const Ray& ray) { best_.t = ray.t_max; }

  /// Hits beyond this change nothing.
  double bound() const { return best_.t; }
  /// Returns true when nothing more need be told.
  bool found(const PrimitiveId& id, const Crossing& crossing) {
    if (crossing.t < best_.t || (crossing.t == best_.t && id < best_.id)) {
      best_ = {crossing.t, id, crossing.u, crossing.v};
    }
    return false;
  }
  Hit result() const { return best_ ? best_ : Hit{}; }

 private:
  Hit best_;
};

/// The closest hit beyond another in the order (t, instance, primitive).
class AfterQuery {
 public:
  static constexpr bool kAny = false;

  AfterQuery(const Ray& ray, const Hit& after, const std::vector<Sphere>& spheres)
      : closest_(ray),
        after_(after),
        spheres_(spheres),
        ray_(trace_setup(ray.origin, ray.direction, ray.t_max)) {}

  double bound() const { return closest_.bound(); }
  bool found(const PrimitiveId& id, const Crossing& crossing) {
    consider(id, crossing);
    // A sphere tells of its near side alone; the far one may be the next.
    Crossing far;
    if (id.instance == 0 && id.primitive < spheres_.size() &&
        intersect(ray_, spheres_[id.primitive], true, far)) {
      consider(id, far);
    }
    return false;
  }
  Hit result() const { return closest_.result(); }

 private:
  void consider(const PrimitiveId& id, const Crossing& crossing) {
    if (crossing.t > after_.t || (crossing.t == after_.t && id > after_.id)) {
      closest_.found(id, crossing);
    }
  }

  ClosestQuery closest_;
  Hit after_;
  const std::vector<Sphere>& spheres_;
  TracedRay ray_;
};

class AnyQuery {
 public:
  static constexpr bool kAny = true;

  explicit AnyQuery(const Ray& ray) : t_max_(ray.t_max) {}

  double bound() const { return t_max_; }
  bool found(const PrimitiveId&, const Crossing&) { return true; }

 private:
  double t_max_;
};

}  // namespace bandsaw
