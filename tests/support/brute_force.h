#pragma once

// Finds the closest hit without a BVH, as the reference for tests of BVHs: every BVH must find the
// same hit, bit for bit.

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw::test {

/// Returns the closest hit. Of several hits at the same distance, returns the one with the lowest
/// id. Returns Hit{}, which converts to false, if the ray hits nothing or cannot be traced (NaN,
/// zero direction).
Hit closest_by_brute_force(const Geometry& geometry, const Ray& ray);

/// True if id, t, u and v are equal, bit for bit.
bool same_hit(const Hit& a, const Hit& b);

}  // namespace bandsaw::test
