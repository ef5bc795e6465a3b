#pragma once

// Rays as a renderer shoots them. Their origins and directions are floats, so that every kernel
// traces the very same ray.

#include <vector>

#include "renderlib/accel/accel.h"

namespace bandsaw::bench {

struct RaySets {
  std::vector<Ray> primary;  ///< 1024 x 1024 pixels in tiles of 8 x 8
  std::vector<Ray> bounce;   ///< cosine hemisphere from where those hit
  std::vector<Ray> shadow;   ///< from there to points of a light; t in (0, 1)
};

RaySets make_rays(const Mesh& mesh, const Accel& accel, bool from_within);

}  // namespace bandsaw::bench
