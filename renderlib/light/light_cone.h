#pragma once

// Orientation cones of groups of lights, for building a light tree.

#include "renderlib/light/light_bound.h"

namespace bandsaw {

/// Angles in radians; the fields correspond to those of `LightBound`.
struct LightCone {
  Vec3 axis{0, 0, 1};
  double spread = 0;  ///< in [0, pi]
  double reach = 0;   ///< in [0, pi / 2]
  bool two_sided = false;
};

LightCone cone_of(const LightBound& bound);

/// Returns the smallest cone that contains both; the whole sphere if their axes are opposite.
LightCone merged(const LightCone& a, const LightCone& b);

/// Returns the cosine-weighted measure of the directions that lights in the cone reach: M_Omega of
/// Conty Estevez and Kulla 2018, section 4.4, equation (1).
double orientation_measure(const LightCone& cone);

}  // namespace bandsaw
