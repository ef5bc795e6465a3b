#pragma once

// Lights without size, as glTF's KHR_lights_punctual defines them: they light surfaces and throw
// hard shadows, but nothing that follows a direction ever meets them, so they are not seen
// themselves, nor in mirrors. A closed set.

#include <cstddef>
#include <variant>

#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Parallel light, from infinitely far.
struct DirectionalLight {
  Vec3 direction{0, 0, -1};  ///< unit, the way that the light goes
  Rgb irradiance{1, 1, 1};   ///< of a surface that faces it; >= 0, finite
};

/// The same to all sides, falling off with the square of the distance.
struct PointLight {
  Vec3 position;
  Rgb intensity{1, 1, 1};  ///< irradiance at distance 1; >= 0, finite
};

/// A point light within a cone: all of it up to the inner angle, none from the outer one on,
/// between them the square of a ramp that is linear in the cosine.
struct SpotLight {
  Vec3 position;
  Vec3 direction{0, 0, -1};  ///< unit, the cone's axis, the way that the light goes
  Rgb intensity{1, 1, 1};    ///< at the axis; >= 0, finite
  double cos_inner = 1;      ///< cosines of the angles to the axis; inner > outer >= 0, or equal
  double cos_outer = 0.70710678118654752440;
};

using DeltaLight = std::variant<DirectionalLight, PointLight, SpotLight>;

/// The light moved and turned with its surroundings. Its numbers stay as they are, whatever the map
/// scales. `to` is regular.
DeltaLight placed(const DeltaLight& light, const Transform& to);

/// Most directional lights of a scene: each is judged at every point that asks for light.
inline constexpr std::size_t kMostDirectionalLights = 8;

/// What arrives at a point if nothing is between.
struct Arrival {
  Vec3 way;        ///< to the light; unit if it is infinitely far
  Rgb irradiance;  ///< of a surface that faces it
};
Arrival arrival(const DirectionalLight& light, const Vec3& at);
Arrival arrival(const PointLight& light, const Vec3& at);
Arrival arrival(const SpotLight& light, const Vec3& at);

}  // namespace bandsaw
