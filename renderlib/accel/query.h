#pragma once

// The queries for a ray: its closest hit, its closest hit beyond an earlier one, or whether it hits
// anything. A query is the template parameter `Query` of the functions of trace.h. These functions
// test shapes in double precision, and call the query's found() for each hit, in any order.

#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/ray.h"

namespace bandsaw {

class ClosestQuery {
 public:
  /// True if any hit finishes the query, so that boxes need not be visited in order.
  static constexpr bool kAny = false;
  /// True if the far intersection of a sphere is reported in addition to the near one.
  static constexpr bool kBothSides = false;

  explicit ClosestQuery(const Ray& ray) { best_.t = ray.t_max; }

  /// Returns the distance beyond which hits are irrelevant.
  double bound() const { return best_.t; }
  /// Reports a hit; returns true if traversal can stop.
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

/// Finds the closest hit beyond the hit `after`, in the order (t, instance, primitive).
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

/// Finds out whether there is any hit.
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
