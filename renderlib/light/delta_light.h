#pragma once

// Delta lights, as defined by glTF's KHR_lights_punctual: directional, point and spot lights. They
// illuminate surfaces and cast hard shadows, but no sampled direction ever hits them, so they are
// invisible to the camera and in mirrors. A closed set.

#include <cstddef>
#include <variant>

#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Parallel light from infinitely far away.
struct DirectionalLight {
  Vec3 direction{0, 0, -1};  ///< unit, the direction in which the light travels
  Rgb irradiance{1, 1, 1};   ///< of a surface that faces the light; >= 0, finite
};

/// Emits equally in all directions; irradiance falls off with the square of the distance.
struct PointLight {
  Vec3 position;
  Rgb intensity{1, 1, 1};  ///< radiant intensity: the irradiance at distance 1; >= 0, finite
};

/// A point light restricted to a cone: full intensity within the inner angle, none beyond the outer
/// angle, and between them the square of a ramp that is linear in the cosine.
struct SpotLight {
  Vec3 position;
  Vec3 direction{0, 0, -1};  ///< unit, the cone's axis, the direction in which the light travels
  Rgb intensity{1, 1, 1};    ///< radiant intensity on the axis; >= 0, finite
  double cos_inner = 1;      ///< cosines of the angles to the axis; cos_inner >= cos_outer >= 0
  double cos_outer = 0.70710678118654752440;
};

using DeltaLight = std::variant<DirectionalLight, PointLight, SpotLight>;

/// Returns the light transformed by `to`, which MUST be regular. Only position and direction
/// change; intensity and irradiance are not scaled.
DeltaLight placed(const DeltaLight& light, const Transform& to);

/// Maximum number of directional lights in a scene: all of them are evaluated at every point that
/// samples light.
inline constexpr std::size_t kMaxDirectionalLights = 8;

/// Unoccluded illumination at a point.
struct Arrival {
  Vec3 to_light;   ///< vector to the light; a unit vector if the light is infinitely far away
  Rgb irradiance;  ///< of a surface that faces the light
};
Arrival arrival(const DirectionalLight& light, const Vec3& at);
Arrival arrival(const PointLight& light, const Vec3& at);
Arrival arrival(const SpotLight& light, const Vec3& at);

}  // namespace bandsaw
