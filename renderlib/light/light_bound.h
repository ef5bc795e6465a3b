#pragma once

// What a light, or a group of them, can give to a point at most: by this one of several is chosen.
//
// Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting",
// sections 4.1 and 4.2, with the bounds of Pharr, Jakob, Humphreys, "Physically Based Rendering",
// 4th ed., 12.6.3: a ball around the lights, and a cone around the directions that they face.

#include "renderlib/light/delta_light.h"
#include "renderlib/light/receiver.h"
#include "renderlib/light/shape_light.h"

namespace bandsaw {

struct LightBound {
  Ball ball;
  /// Radiant intensity in the brightest direction, the mean of the channels: what
  /// arrives at distance 1 of one that faces it.
  double intensity = 0;
  Vec3 axis{0, 0, 1};      ///< unit: the middle of the directions that the lights face
  double cos_spread = -1;  ///< of the largest angle between axis and such a direction
  double cos_reach = 0;    ///< of the angle to it beyond which nothing is given
  bool two_sided = false;  ///< the same around -axis
  bool flat = false;       ///< all of it lies in the plane across the axis
};

/// Of a shape whose radiance is `radiance` on the mean.
LightBound bound_of(const ShapeView& shape, double radiance, bool one_sided);
LightBound bound_of(const PointLight& light);
LightBound bound_of(const SpotLight& light);

/// intensity x cosines / distance^2, each factor at its largest over the bound; zero only where
/// nothing can arrive.
double importance(const LightBound& bound, const Receiver& receiver);
/// The integral of intensity / distance^2 along the stretch, as if its nearest point were its
/// middle, faded as on the way by that point. Where the lights face does not count: a ray meets a
/// spot's cone anywhere.
double importance(const LightBound& bound, const LitStretch& stretch);

/// The mean of the channels.
inline double brightness(const Rgb& c) { return (double{c.r} + c.g + c.b) / 3; }

}  // namespace bandsaw
