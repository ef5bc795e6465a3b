#include "renderlib/import/scene_file/read_lights.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

absl::StatusOr<Rgb> read_brightness(const Field& in, const std::string& name, bool given,
                                    const scene::Color& from) {
  if (!given) {
    return in.error(name, absl::StrCat("is required, for example ", name, " { rgb: [1, 1, 1] }"));
  }
  return read_color(in.child(name), from, kMaxRadiance);
}

absl::StatusOr<DeltaLight> read_directional(const Field& in, const scene::DirectionalLight& from) {
  DirectionalLight light;
  ASSIGN_OR_RETURN(const Vec3 direction, read_direction(in, "direction", from.direction()));
  light.direction = normalize(direction);
  ASSIGN_OR_RETURN(light.irradiance,
                   read_brightness(in, "irradiance", from.has_irradiance(), from.irradiance()));
  return DeltaLight(light);
}

absl::StatusOr<DeltaLight> read_point(const Field& in, const scene::PointLight& from) {
  PointLight light;
  ASSIGN_OR_RETURN(light.position, read_vec3(in, "position", from.position()));
  ASSIGN_OR_RETURN(light.intensity,
                   read_brightness(in, "intensity", from.has_intensity(), from.intensity()));
  return DeltaLight(light);
}

absl::StatusOr<Vec3> read_axis(const Field& in, const scene::SpotLight& from,
                               const Vec3& position) {
  if (from.direction().empty() == from.look_at().empty()) {
    return in.error("direction", "one of direction, look_at is required, not both");
  }
  if (from.look_at().empty()) {
    ASSIGN_OR_RETURN(const Vec3 direction, read_direction(in, "direction", from.direction()));
    return normalize(direction);
  }
  ASSIGN_OR_RETURN(const Vec3 target, read_vec3(in, "look_at", from.look_at()));
  if (target == position) {
    return in.error("look_at", "must differ from position");
  }
  return normalize(target - position);
}

absl::StatusOr<DeltaLight> read_spot(const Field& in, const scene::SpotLight& from) {
  SpotLight light;
  ASSIGN_OR_RETURN(light.position, read_vec3(in, "position", from.position()));
  ASSIGN_OR_RETURN(light.direction, read_axis(in, from, light.position));
  ASSIGN_OR_RETURN(light.intensity,
                   read_brightness(in, "intensity", from.has_intensity(), from.intensity()));
  constexpr double kRightAngle = 90;
  const double outer = from.has_outer_angle() ? from.outer_angle() : 45;
  if (!(outer > 0 && outer <= kRightAngle)) {
    return in.error("outer_angle", absl::StrCat("must be in (0, 90] degrees, is ", outer));
  }
  RETURN_IF_ERROR(check_range(in, "inner_angle", from.inner_angle(), 0, outer));
  light.cos_inner = sincos_degrees(from.inner_angle()).cos;
  light.cos_outer = sincos_degrees(outer).cos;
  return DeltaLight(light);
}

absl::StatusOr<DeltaLight> read_light(const Field& in, const scene::Light& from) {
  switch (from.kind_case()) {
    case scene::Light::kDirectional:
      return read_directional(in.child("directional"), from.directional());
    case scene::Light::kPoint:
      return read_point(in.child("point"), from.point());
    case scene::Light::kSpot:
      return read_spot(in.child("spot"), from.spot());
    default:
      break;
  }
  return in.error("is empty: write directional, point or spot");
}

}  // namespace

absl::Status read_lights(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  std::size_t directional = 0;
  for (int i = 0; i < from.light_size(); ++i) {
    const Field in = root.child("light", i);
    ASSIGN_OR_RETURN(const DeltaLight light, read_light(in, from.light(i)));
    directional += std::holds_alternative<DirectionalLight>(light) ? 1 : 0;
    if (directional > kMaxDirectionalLights) {
      return in.error("directional", absl::StrCat("is one more than the ", kMaxDirectionalLights,
                                                  " directional lights that a scene may have"));
    }
    draft.out.scene.lights.push_back(light);
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
