// Reads the lights of a scene file: one function for each kind checks its fields and returns a
// DeltaLight.

#include "renderlib/import/scene_file/read_lights.h"

#include <variant>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_textures.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Reads the required colour `name`. `given` is true if the field is present.
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

/// Returns the unit vector of a spot light's axis, from `direction` or from `look_at`.
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

/// Reads `up` and sets the directions `right` and `up` of an image that is projected along the unit
/// vector `axis`.
absl::Status read_sides(const Field& in, const Numbers& from, bool mirrored, const Vec3& axis,
                        ProjectedImage& image) {
  ASSIGN_OR_RETURN(const Vec3 up, read_vec3(in, "up", from, Vec3{0, 1, 0}));
  const Vec3 right = length_squared(up) > 0 ? cross(axis, normalize(up)) : Vec3{};
  // The sine of the angle between axis and up must be above 1e-12.
  if (!(length_squared(right) > 1e-24)) {
    return in.error("up", from.empty()
                              ? "is [0, 1, 0] unless written, and this vector is parallel to the "
                                "light's axis; write another vector, for example [0, 0, 1]"
                              : "must not be zero or parallel to the light's axis");
  }
  image.right = normalize(right);
  image.up = cross(image.right, axis);
  image.right = mirrored ? -image.right : image.right;
  return absl::OkStatus();
}

/// Returns width / height of an image texture; 1 for all other textures.
double aspect_of(const Texture& texture) {
  const auto* image = std::get_if<ImageTexture>(&texture);
  return image != nullptr ? static_cast<double>(image->width) / image->height : 1;
}

absl::StatusOr<DeltaLight> read_projector(const Field& in, const scene::ProjectorLight& from,
                                          SceneDraft& draft) {
  ProjectorLight light;
  ASSIGN_OR_RETURN(light.position, read_vec3(in, "position", from.position()));
  ASSIGN_OR_RETURN(const Vec3 target, read_vec3(in, "look_at", from.look_at()));
  if (target == light.position) {
    return in.error("look_at", "must differ from position");
  }
  light.direction = normalize(target - light.position);
  RETURN_IF_ERROR(read_sides(in, from.up(), from.mirrored(), light.direction, light.image));
  if (from.has_intensity()) {
    ASSIGN_OR_RETURN(light.intensity,
                     read_color(in.child("intensity"), from.intensity(), kMaxRadiance));
  }
  const double fov = from.has_vertical_fov() ? from.vertical_fov() : 40;
  if (!(fov > 0 && fov < 180)) {
    return in.error("vertical_fov", absl::StrCat("must lie in (0, 180) degrees, is ", fov));
  }
  if (!from.has_image()) {
    return in.error("image", "is required: the texture that is projected");
  }
  ASSIGN_OR_RETURN(light.image.texture,
                   read_texture(in.child("image"), from.image(), kMaxRadiance, draft));
  const double aspect =
      from.has_aspect() ? from.aspect() : aspect_of(draft.textures[light.image.texture]);
  if (from.has_aspect()) {
    RETURN_IF_ERROR(check_range(in, "aspect", aspect, 1e-3, 1e3));
  }
  light.image.half_height = tan_degrees(fov / 2);
  light.image.half_width = light.image.half_height * aspect;
  return DeltaLight(light);
}

/// Sets the image that a spot light projects, if there is one. `outer` is the spot's outer angle in
/// degrees.
absl::Status read_spot_image(const Field& in, const scene::SpotLight& from, double outer,
                             SceneDraft& draft, SpotLight& light) {
  if (!from.has_image()) {
    if (!from.up().empty() || from.mirrored()) {
      return in.error(from.mirrored() ? "mirrored" : "up", "is only for a light with an image");
    }
    return absl::OkStatus();
  }
  if (!(outer < 90)) {
    return in.error("image", "needs an outer_angle below 90 degrees");
  }
  ProjectedImage image;
  RETURN_IF_ERROR(read_sides(in, from.up(), from.mirrored(), light.direction, image));
  ASSIGN_OR_RETURN(image.texture,
                   read_texture(in.child("image"), from.image(), kMaxRadiance, draft));
  image.half_width = image.half_height = tan_degrees(outer);
  light.image = image;
  return absl::OkStatus();
}

absl::StatusOr<DeltaLight> read_spot(const Field& in, const scene::SpotLight& from,
                                     SceneDraft& draft) {
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
  if (!scene::SpotLight::Falloff_IsValid(from.falloff())) {
    return in.error("falloff", "is none of the values that it can have");
  }
  // The enums are declared in the same order, from 0.
  light.falloff = static_cast<SpotLight::Falloff>(from.falloff());
  RETURN_IF_ERROR(read_spot_image(in, from, outer, draft, light));
  return DeltaLight(light);
}

absl::StatusOr<DeltaLight> read_light(const Field& in, const scene::Light& from,
                                      SceneDraft& draft) {
  switch (from.kind_case()) {
    case scene::Light::kDirectional:
      return read_directional(in.child("directional"), from.directional());
    case scene::Light::kPoint:
      return read_point(in.child("point"), from.point());
    case scene::Light::kSpot:
      return read_spot(in.child("spot"), from.spot(), draft);
    case scene::Light::kProjector:
      return read_projector(in.child("projector"), from.projector(), draft);
    case scene::Light::KIND_NOT_SET:
      break;
  }
  return in.error("is empty: write directional, point, spot or projector");
}

}  // namespace

absl::Status read_lights(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  std::size_t directional = 0;
  for (int i = 0; i < from.light_size(); ++i) {
    const Field in = root.child("light", i);
    ASSIGN_OR_RETURN(const DeltaLight light, read_light(in, from.light(i), draft));
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
