#pragma once

// Delta lights: directional, point and spot lights, as defined by glTF's KHR_lights_punctual, and
// projectors. They illuminate surfaces and cast hard shadows, but no sampled direction ever hits
// them. So they are invisible to the camera and in mirrors, and only light sampling finds them
// (light/lights.h). README.md of renderlib lists what a further kind of light needs.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Parallel light from infinitely far away.
struct DirectionalLight {
  Vec3 direction{0, 0, -1};  ///< unit, the direction in which the light travels
  Rgb irradiance{1, 1, 1};   ///< at a surface that faces the light; >= 0, finite
};

/// Emits equally in all directions; irradiance falls off with the square of the distance.
struct PointLight {
  Vec3 position;
  Rgb intensity{1, 1, 1};  ///< radiant intensity: the irradiance at distance 1; >= 0, finite
};

/// An image on the plane at distance 1 in front of a light, perpendicular to the light's axis. It
/// covers the rectangle of +-half_width along `right` and +-half_height along `up` around the axis;
/// u increases along `right`, v along `up`, both from 0 to 1.
struct ProjectedImage {
  TextureId texture{};
  Vec3 right{1, 0, 0};     ///< unit, perpendicular to the axis
  Vec3 up{0, 1, 0};        ///< unit, perpendicular to the axis and to `right`
  double half_width = 1;   ///< in [kMinHalfImage, kMaxHalfImage]
  double half_height = 1;  ///< in the same range
};
inline constexpr double kMinHalfImage = 1e-9;
inline constexpr double kMaxHalfImage = 1e9;

/// A point light restricted to a cone: full intensity within the inner angle, none beyond the outer
/// angle, and a fall-off between them.
struct SpotLight {
  /// The fall-off between the angles. t is a ramp that is linear in the cosine: 0 at the outer
  /// angle and 1 at the inner angle.
  enum class Falloff : std::uint8_t {
    kSquare,       ///< t^2 (glTF)
    kSmooth,       ///< 3 t^2 - 2 t^3
    kLinearAngle,  ///< linear in the angle
  };
  Vec3 position;
  Vec3 direction{0, 0, -1};  ///< unit, the cone's axis, the direction in which the light travels
  Rgb intensity{1, 1, 1};    ///< radiant intensity on the axis; >= 0, finite
  double cos_inner = 1;      ///< cosines of the angles to the axis; cos_inner >= cos_outer >= 0
  double cos_outer = 0.70710678118654752440;  ///< by default the cosine of 45 degrees, as in glTF
  Falloff falloff = Falloff::kSquare;
  /// An image that multiplies the intensity. Beyond the edges of its rectangle the texture is
  /// repeated or clamped, as its wrap mode says.
  std::optional<ProjectedImage> image = std::nullopt;
};

/// Projects an image from a point. In a direction at the angle t to the axis, the radiant intensity
/// is image * intensity / cos(t)^3. So the irradiance on the plane perpendicular to the axis at
/// distance 1 is image * intensity. The intensity is 0 beyond the image's edges and behind the
/// light.
struct ProjectorLight {
  Vec3 position;
  Vec3 direction{0, 0, -1};  ///< unit, the axis, through the centre of the image
  Rgb intensity{1, 1, 1};    ///< >= 0, finite
  ProjectedImage image;
};

using DeltaLight = std::variant<DirectionalLight, PointLight, SpotLight, ProjectorLight>;

/// Returns the light transformed by `to`, which MUST be invertible. Only position and directions
/// change; intensity, irradiance and angles are not scaled.
DeltaLight placed(const DeltaLight& light, const Transform& to);

/// Maximum number of directional lights in a scene. It is small, because all of them are evaluated
/// at every point that samples light.
inline constexpr std::size_t kMaxDirectionalLights = 8;

/// Unoccluded illumination at a point.
struct Arrival {
  Vec3 to_light;   ///< vector to the light; a unit vector if the light is infinitely far away
  Rgb irradiance;  ///< at a surface that faces the light
};
/// Returns the illumination at the point `at`. `textures` are those of the scene.
Arrival arrival(const DirectionalLight& light, const std::vector<Texture>& textures,
                const Vec3& at);
Arrival arrival(const PointLight& light, const std::vector<Texture>& textures, const Vec3& at);
Arrival arrival(const SpotLight& light, const std::vector<Texture>& textures, const Vec3& at);
Arrival arrival(const ProjectorLight& light, const std::vector<Texture>& textures, const Vec3& at);

}  // namespace bandsaw
