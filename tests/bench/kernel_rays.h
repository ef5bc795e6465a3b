#pragma once

// Sets of rays for kernel_bench, as a renderer traces them. Embree reads floats, so the origins and
// directions are rounded to floats. Then every kernel traces the same rays.

#include <vector>

#include "renderlib/accel/accel.h"

namespace bandsaw::bench {

struct RaySets {
  std::vector<Ray> primary;  ///< 1024 x 1024 pixels in tiles of 8 x 8
  std::vector<Ray> bounce;   ///< cosine-weighted, from the hits of `primary`
  std::vector<Ray> shadow;   ///< from the hits of `primary` to points of a light; t in (0, 1)
};

/// Returns rays for a camera that looks at the middle of the mesh, and for a light above the
/// middle. If `from_within`, as in a room, camera and light are inside the mesh's bounding box;
/// otherwise they are outside.
RaySets make_rays(const Mesh& mesh, const Accel& accel, bool from_within);

}  // namespace bandsaw::bench
