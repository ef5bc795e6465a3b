#include "renderlib/light/delta_light.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {
namespace {

/// Returns 1 / length^2, at most 1e30; 0 at the light itself, which receives no light from it.
float over_distance2(const Vec3& to_light) {
  const double distance2 = length_squared(to_light);
  return distance2 > 0 ? static_cast<float>(std::min(1 / distance2, 1e30)) : 0.0f;
}

struct Placed {
  const Transform& to;

  DeltaLight operator()(DirectionalLight light) const {
    light.direction = normalize(to.direction(light.direction));
    return light;
  }
  DeltaLight operator()(PointLight light) const {
    light.position = to.point(light.position);
    return light;
  }
  DeltaLight operator()(SpotLight light) const {
    light.position = to.point(light.position);
    light.direction = normalize(to.direction(light.direction));
    return light;
  }
};

}  // namespace

DeltaLight placed(const DeltaLight& light, const Transform& to) {
  return std::visit(Placed{to}, light);
}

Arrival arrival(const DirectionalLight& light, const Vec3&) {
  return {-light.direction, light.irradiance};
}

Arrival arrival(const PointLight& light, const Vec3& at) {
  const Vec3 to_light = light.position - at;
  return {to_light, light.intensity * over_distance2(to_light)};
}

Arrival arrival(const SpotLight& light, const Vec3& at) {
  const Vec3 to_light = light.position - at;
  const double distance = length(to_light);
  const double cosine = distance > 0 ? -dot(to_light, light.direction) / distance : 0;
  if (cosine <= light.cos_outer) {
    return {to_light, {}};
  }
  const double ramp = cosine >= light.cos_inner
                          ? 1
                          : (cosine - light.cos_outer) / (light.cos_inner - light.cos_outer);
  return {to_light, light.intensity * (over_distance2(to_light) * static_cast<float>(ramp * ramp))};
}

}  // namespace bandsaw
