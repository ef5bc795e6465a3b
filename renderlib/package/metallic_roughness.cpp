// Copies the fields of glTF's material to the manifest and back.

#include "renderlib/package/metallic_roughness.h"

#include "renderlib/base/status_macros.h"
#include "renderlib/package/material_parts.h"

namespace bandsaw {

void encode_metallic_roughness(const MetallicRoughness& from, package::Gltf& to) {
  encode(from.base_color, *to.mutable_base_color());
  encode(from.metallic, *to.mutable_metallic());
  encode(from.roughness, *to.mutable_roughness());
  to.set_index_of_refraction(from.index_of_refraction);
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

absl::StatusOr<MetallicRoughness> decode_metallic_roughness(const package::Gltf& from,
                                                            const std::string& field) {
  MetallicRoughness to;
  ASSIGN_OR_RETURN(to.base_color, decode(from.base_color(), field + ".base_color"));
  to.metallic = decode(from.metallic());
  to.roughness = decode(from.roughness());
  to.index_of_refraction = from.index_of_refraction();
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
