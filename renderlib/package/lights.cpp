// Converts each kind of light, and environments, to and from messages of proto/package.proto.

#include "renderlib/package/lights.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/material_parts.h"

namespace bandsaw {
namespace {

void encode(const Vec3& from, google::protobuf::RepeatedField<double>& to) {
  to.Add(from.x);
  to.Add(from.y);
  to.Add(from.z);
}

void encode(const ProjectedImage& from, package::ProjectedImage& to) {
  to.set_texture(static_cast<std::uint32_t>(from.texture));
  encode(from.right, *to.mutable_right());
  encode(from.up, *to.mutable_up());
  to.set_half_width(from.half_width);
  to.set_half_height(from.half_height);
}

/// Encodes a light into `to`; called by std::visit.
struct EncodeLight {
  package::Light& to;

  void operator()(const DirectionalLight& light) const {
    encode(light.direction, *to.mutable_directional()->mutable_direction());
    encode(light.irradiance, *to.mutable_directional()->mutable_irradiance());
  }
  void operator()(const PointLight& light) const {
    encode(light.position, *to.mutable_point()->mutable_position());
    encode(light.intensity, *to.mutable_point()->mutable_intensity());
  }
  void operator()(const SpotLight& light) const {
    package::SpotLight& spot = *to.mutable_spot();
    encode(light.position, *spot.mutable_position());
    encode(light.direction, *spot.mutable_direction());
    encode(light.intensity, *spot.mutable_intensity());
    spot.set_cos_inner(light.cos_inner);
    spot.set_cos_outer(light.cos_outer);
    // The enums are declared in the same order, from 0.
    spot.set_falloff(static_cast<package::SpotLight::Falloff>(light.falloff));
    if (light.image) {
      encode(*light.image, *spot.mutable_image());
    }
  }
  void operator()(const ProjectorLight& light) const {
    package::ProjectorLight& projector = *to.mutable_projector();
    encode(light.position, *projector.mutable_position());
    encode(light.direction, *projector.mutable_direction());
    encode(light.intensity, *projector.mutable_intensity());
    encode(light.image, *projector.mutable_image());
  }
};

absl::StatusOr<ProjectedImage> decode_image(const package::ProjectedImage& from,
                                            const std::string& field) {
  ProjectedImage to;
  to.texture = TextureId{from.texture()};
  ASSIGN_OR_RETURN(to.right, decode_vec3(from.right(), field + ".right"));
  ASSIGN_OR_RETURN(to.up, decode_vec3(from.up(), field + ".up"));
  to.half_width = from.half_width();
  to.half_height = from.half_height();
  return to;
}

absl::StatusOr<DeltaLight> decode_spot(const package::SpotLight& from, const std::string& field) {
  SpotLight light;
  ASSIGN_OR_RETURN(light.position, decode_vec3(from.position(), field + ".position"));
  ASSIGN_OR_RETURN(light.direction, decode_vec3(from.direction(), field + ".direction"));
  ASSIGN_OR_RETURN(light.intensity, decode_rgb(from.intensity().rgb(), field + ".intensity"));
  light.cos_inner = from.cos_inner();
  light.cos_outer = from.cos_outer();
  if (!package::SpotLight::Falloff_IsValid(from.falloff())) {
    return manifest_error(field + ".falloff", "is of no kind that this program knows");
  }
  light.falloff = static_cast<SpotLight::Falloff>(from.falloff());
  if (from.has_image()) {
    ASSIGN_OR_RETURN(light.image, decode_image(from.image(), field + ".image"));
  }
  return DeltaLight(light);
}

absl::StatusOr<DeltaLight> decode_projector(const package::ProjectorLight& from,
                                            const std::string& field) {
  ProjectorLight light;
  ASSIGN_OR_RETURN(light.position, decode_vec3(from.position(), field + ".position"));
  ASSIGN_OR_RETURN(light.direction, decode_vec3(from.direction(), field + ".direction"));
  ASSIGN_OR_RETURN(light.intensity, decode_rgb(from.intensity().rgb(), field + ".intensity"));
  ASSIGN_OR_RETURN(light.image, decode_image(from.image(), field + ".image"));
  return DeltaLight(light);
}

absl::StatusOr<DeltaLight> decode(const package::Light& from, const std::string& field) {
  if (from.has_directional()) {
    DirectionalLight light;
    ASSIGN_OR_RETURN(light.direction,
                     decode_vec3(from.directional().direction(), field + ".directional.direction"));
    ASSIGN_OR_RETURN(light.irradiance, decode_rgb(from.directional().irradiance().rgb(),
                                                  field + ".directional.irradiance"));
    return DeltaLight(light);
  }
  if (from.has_point()) {
    PointLight light;
    ASSIGN_OR_RETURN(light.position,
                     decode_vec3(from.point().position(), field + ".point.position"));
    ASSIGN_OR_RETURN(light.intensity,
                     decode_rgb(from.point().intensity().rgb(), field + ".point.intensity"));
    return DeltaLight(light);
  }
  if (from.has_spot()) {
    return decode_spot(from.spot(), field + ".spot");
  }
  if (from.has_projector()) {
    return decode_projector(from.projector(), field + ".projector");
  }
  return manifest_error(field, "is of no kind that this program knows");
}

}  // namespace

void encode_environment(const Environment& from, package::Environment& to) {
  // The enums are declared in the same order; the protocol's enum has an additional 0.
  to.set_kind(static_cast<package::Environment::Kind>(static_cast<int>(from.kind) + 1));
  for (const TextureId image : from.images) {
    to.add_image(static_cast<std::uint32_t>(image));
  }
  to.set_strength(from.strength);
  for (const Vec3& axis : {from.axes.x, from.axes.y, from.axes.z}) {
    encode(axis, *to.mutable_axes());
  }
}

void encode_light(const DeltaLight& from, package::Light& to) { std::visit(EncodeLight{to}, from); }

absl::StatusOr<Environment> decode_environment(const package::Environment& from) {
  const std::string field = "background.environment";
  Environment to;
  ASSIGN_OR_RETURN(to.kind,
                   decode_enum<Environment::Kind>(from.kind(), /*last=*/2, field + ".kind"));
  for (const std::uint32_t image : from.image()) {
    to.images.push_back(TextureId{image});
  }
  to.strength = from.strength();
  if (from.axes_size() != 9) {
    return manifest_error(field + ".axes",
                          absl::StrCat("must have 9 numbers, has ", from.axes_size()));
  }
  const auto axis = [&](int i) { return Vec3{from.axes(i), from.axes(i + 1), from.axes(i + 2)}; };
  to.axes = {axis(0), axis(3), axis(6)};
  return to;
}

absl::StatusOr<std::vector<DeltaLight>> decode_lights(const package::Manifest& manifest) {
  std::vector<DeltaLight> lights;
  for (int i = 0; i < manifest.light_size(); ++i) {
    ASSIGN_OR_RETURN(const DeltaLight light,
                     decode(manifest.light(i), absl::StrCat("light[", i, "]")));
    lights.push_back(light);
  }
  return lights;
}

}  // namespace bandsaw
