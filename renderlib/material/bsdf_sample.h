#pragma once

// Results of sampling and evaluating a BSDF. wo is the direction towards the camera, and wi the
// direction towards the incoming light. Values include the cosine (material/bsdf.h).

#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// The geometric and the shading normal, both unit vectors on the side of wo. Light passes from one
/// side of `geometric` to the other only through transmissive materials, whatever `shading` is.
struct SidedNormals {
  Vec3 geometric;
  Vec3 shading;
};

struct BsdfSample {
  Vec3 wi;             ///< unit
  Rgb weight;          ///< value / pdf
  double pdf = 0;      ///< 0 if `delta`
  bool delta = false;  ///< a delta direction, for which evaluate() is zero
  /// 1, except for a refraction. Then it is (index on the side of wo / index on the side of wi)^2,
  /// and `weight` contains this factor. Refraction compresses radiance in the denser medium: L /
  /// index^2 is invariant along a ray.
  double compression = 1;
  /// True if the scattering counts towards max_depth. Only light that passes a ThinDielectric with
  /// `free_passage` does not count.
  bool counts = true;
};

struct BsdfValue {
  Rgb value;
  double pdf = 0;  ///< pdf with which sample() samples wi
};

}  // namespace bandsaw
