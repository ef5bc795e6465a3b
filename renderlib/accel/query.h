#pragma once

// What is asked of the trees: the closest hit, or whether there is any. Both hear of every hit that
// the double tests find, in any order.

#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

class ClosestQuery {
 public:
  static constexpr bool kAny = false;
  /// Whether far sides of spheres count beside near ones.
  static constexpr bool kBothSides = false;

  explicit ClosestQuery(const Ray& ray) { best_.t = ray.t_max; }

  /// Hits beyond this change nothing.
  double bound() const { return best_.t; }
  /// Returns true when nothing more need be told.
  bool found(const PrimitiveId& id, const Crossing& crossing) {
    if (crossing.t < best_.t || (crossing.t == best_.t && id < best_.id)) {
      best_ = {crossing.t, id, crossing.u, crossing.v, crossing.corners};
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
  static constexpr bool kBothSides = true;

  AfterQuery(const Ray& ray, const Hit& after) : closest_(ray), after_(after) {}

  double bound() const { return closest_.bound(); }
  bool found(const PrimitiveId& id, const Crossing& crossing) {
    if (crossing.t > after_.t || (crossing.t == after_.t && id > after_.id)) {
      closest_.found(id, crossing);
    }
    return false;
  }
  Hit result() const { return closest_.result(); }

 private:
  ClosestQuery closest_;
  Hit after_;
};

class AnyQuery {
 public:
  static constexpr bool kAny = true;
  static constexpr bool kBothSides = false;

  explicit AnyQuery(const Ray& ray) : t_max_(ray.t_max) {}

  double bound() const { return t_max_; }
  bool found(const PrimitiveId&, const Crossing&) { return true; }

 private:
  double t_max_;
};

}  // namespace bandsaw
