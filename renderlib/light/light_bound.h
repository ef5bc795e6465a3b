#pragma once

// Importance of a light, or of a group of lights, at a point: an approximate upper bound of its
// contribution. Lights are selected with probabilities in proportion to it (light/light_choice.h,
// light/light_tree.h).
//
// The importance is that of Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with
// Adaptive Tree Splitting", sections 4.1 and 4.2, with the bounds of Pharr, Jakob and Humphreys,
// "Physically Based Rendering", 4th ed., 12.6.3: a sphere around the lights and a cone around their
// emission normals.

#include <vector>

#include "renderlib/light/delta_light.h"
#include "renderlib/light/receiver.h"
#include "renderlib/light/shape_light.h"

namespace bandsaw {

/// Bounds of a light or of a group of lights. importance() is computed from them.
struct LightBound {
  Ball ball;
  /// Radiant intensity in the brightest direction, averaged over the channels: the irradiance at
  /// distance 1 of a surface that faces the light.
  double intensity = 0;
  Vec3 axis{0, 0, 1};      ///< unit; axis of the cone that contains the normals of the emitters
  double cos_spread = -1;  ///< cosine of the cone's half-angle (theta_o in the paper)
  /// Cosine of the largest angle, to the normal of an emitter, at which the emitter emits (theta_e
  /// in the paper).
  double cos_reach = 0;
  bool two_sided = false;  ///< the cone around -axis emits in the same way
  bool flat = false;       ///< all emitters lie in one plane perpendicular to the axis
};

/// Returns the bound of a shape. `radiance` is the radiance of the shape, a mean over its surface
/// and the channels.
LightBound bound_of(const ShapeView& shape, double radiance, bool one_sided);
LightBound bound_of(const PointLight& light);
/// `textures` are those of the scene.
LightBound bound_of(const SpotLight& light, const std::vector<Texture>& textures);
LightBound bound_of(const ProjectorLight& light, const std::vector<Texture>& textures);

/// Returns intensity * cosines / distance^2 with each factor at its maximum over the bound; zero
/// only if no light can arrive.
double importance(const LightBound& bound, const Receiver& receiver);
/// Returns the approximate integral of intensity / distance^2 along the segment, as if the segment
/// were centred on its point closest to the light. The medium attenuates the light along the path
/// from the segment's origin through this closest point to the light. The orientation of the light
/// is ignored, because the segment may cross a spot light's cone anywhere.
double importance(const LightBound& bound, const ReceiverSegment& segment);

/// Returns the mean of the channels.
inline double brightness(const Rgb& c) { return (double{c.r} + c.g + c.b) / 3; }

}  // namespace bandsaw
