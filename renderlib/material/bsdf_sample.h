#pragma once

// What sampling and evaluating a material gives; conventions in material/bsdf.h.

#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Two normals on the side that wo is on. No light passes from one side of `geometric` to the other
/// but through glass, whatever the shading normal says.
struct SidedNormals {
  Vec3 geometric;
  Vec3 shading;
};

struct BsdfSample {
  Vec3 wi;             ///< unit
  Rgb weight;          ///< value / density
  double pdf = 0;      ///< 0 when `delta`
  bool delta = false;  ///< one of finitely many directions: eval() cannot see it
  /// Of a refraction, (index of the side of wo / index of the side of wi)^2, a factor of `weight`;
  /// otherwise 1. Radiance is compressed in the denser medium: L / index^2 is what is kept along a
  /// ray.
  double compression = 1;
};

struct BsdfValue {
  Rgb value;
  double pdf = 0;  ///< with which sample() makes wi
};

}  // namespace bandsaw
