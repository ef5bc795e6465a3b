#include "renderlib/package/principled.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_surface.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

void encode(const Channel& from, package::Channel& to) {
  to.set_texture(static_cast<std::uint32_t>(from.texture));
  to.set_factor(from.factor);
}

void encode(const Tint& from, package::Tint& to) {
  to.set_texture(static_cast<std::uint32_t>(from.texture));
  for (const float channel : {from.factor.r, from.factor.g, from.factor.b}) {
    to.add_factor(channel);
  }
}

Channel decode(const package::Channel& from) { return {TextureId{from.texture()}, from.factor()}; }

absl::StatusOr<Tint> decode(const package::Tint& from, const std::string& field) {
  ASSIGN_OR_RETURN(const Rgb factor, decode_rgb(from.factor(), field + ".factor"));
  return Tint{TextureId{from.texture()}, factor};
}

}  // namespace

void encode_principled(const Principled& from, package::Gltf& to) {
  encode(from.base_color, *to.mutable_base_color());
  encode(from.metallic, *to.mutable_metallic());
  encode(from.roughness, *to.mutable_roughness());
  to.set_index_of_refraction(from.index_of_refraction);
  if (from.normal) {
    to.set_normal(static_cast<std::uint32_t>(*from.normal));
  }
  to.set_normal_scale(from.normal_scale);
  encode(from.emissive, *to.mutable_emissive());
  to.set_double_sided(from.double_sided);
  // The enums are declared in the same order.
  to.set_alpha_mode(static_cast<package::Gltf::AlphaMode>(from.alpha_mode));
  encode(from.alpha, *to.mutable_alpha());
  to.set_alpha_cutoff(from.alpha_cutoff);
  encode(from.coat, *to.mutable_coat());
  encode(from.coat_roughness, *to.mutable_coat_roughness());
  encode(from.transmission, *to.mutable_transmission());
  if (from.index_map) {
    to.set_index_texture(static_cast<std::uint32_t>(*from.index_map));
  }
  if (from.coat_normal) {
    to.set_coat_normal(static_cast<std::uint32_t>(*from.coat_normal));
  }
  to.set_coat_normal_scale(from.coat_normal_scale);
}

absl::StatusOr<Principled> decode_principled(const package::Gltf& from, const std::string& field) {
  if (!package::Gltf::AlphaMode_IsValid(from.alpha_mode())) {
    return manifest_error(field + ".alpha_mode",
                          absl::StrCat("is ", from.alpha_mode(), ", which is not a mode"));
  }
  Principled to;
  ASSIGN_OR_RETURN(to.base_color, decode(from.base_color(), field + ".base_color"));
  to.metallic = decode(from.metallic());
  to.roughness = decode(from.roughness());
  to.index_of_refraction = from.index_of_refraction();
  if (from.has_normal()) {
    to.normal = TextureId{from.normal()};
  }
  to.normal_scale = from.normal_scale();
  ASSIGN_OR_RETURN(to.emissive, decode(from.emissive(), field + ".emissive"));
  to.double_sided = from.double_sided();
  to.alpha_mode = static_cast<AlphaMode>(from.alpha_mode());
  to.alpha = decode(from.alpha());
  to.alpha_cutoff = from.alpha_cutoff();
  to.coat = decode(from.coat());
  to.coat_roughness = decode(from.coat_roughness());
  to.transmission = decode(from.transmission());
  if (from.has_index_texture()) {
    to.index_map = TextureId{from.index_texture()};
  }
  if (from.has_coat_normal()) {
    to.coat_normal = TextureId{from.coat_normal()};
  }
  to.coat_normal_scale = from.coat_normal_scale();
  return to;
}

}  // namespace bandsaw
