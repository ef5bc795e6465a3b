#pragma once

// The directions that a group of lights faces, for building a light tree.

#include "renderlib/light/light_bound.h"

namespace bandsaw {

/// Angles in radians; the fields as LightBound has them.
struct LightCone {
  Vec3 axis{0, 0, 1};
  double spread = 0;  ///< in [0, pi]
  double reach = 0;   ///< in [0, pi / 2]
  bool two_sided = false;
};

LightCone cone_of(const LightBound& bound);

/// The smallest cone around both; the whole sphere where their axes are opposite.
LightCone merged(const LightCone& a, const LightCone& b);

/// How much of the sphere lights within the cone reach, weighed by the cosine: M_Omega of Conty
/// Estevez and Kulla 2018, section 4.4, equation (1).
double orientation_measure(const LightCone& cone);

}  // namespace bandsaw
