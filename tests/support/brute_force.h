#pragma once

// The closest hit without any tree: what every tree must find to the bit.

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw::test {

Hit closest_by_brute_force(const Geometry& geometry, const Ray& ray);

/// Bits equal: id, t, u, v.
bool same_hit(const Hit& a, const Hit& b);

}  // namespace bandsaw::test
