// Copies the fields of the principled materials to the manifest and back.

#include "renderlib/package/principled.h"

#include "renderlib/package/material_parts.h"

namespace bandsaw {
namespace {

void encode(const Number& from, package::Number& to) {
  to.set_value(from.value);
  if (from.map) {
    to.set_texture(number_of(*from.map));
  }
}

Number decode(const package::Number& from) {
  return {from.value(), texture_if(from.has_texture(), from.texture())};
}

}  // namespace

void encode_principled(const Principled& from, package::Principled& to) {
  to.set_base_color(number_of(from.base_color));
  to.set_index_of_refraction(from.index_of_refraction);
  encode(from.roughness, *to.mutable_roughness());
  encode(from.anisotropic, *to.mutable_anisotropic());
  encode(from.metallic, *to.mutable_metallic());
  encode(from.spec_trans, *to.mutable_spec_trans());
  encode(from.spec_tint, *to.mutable_spec_tint());
  encode(from.sheen, *to.mutable_sheen());
  encode(from.sheen_tint, *to.mutable_sheen_tint());
  encode(from.flatness, *to.mutable_flatness());
  encode(from.clearcoat, *to.mutable_clearcoat());
  encode(from.clearcoat_gloss, *to.mutable_clearcoat_gloss());
}

Principled decode_principled(const package::Principled& from) {
  Principled to;
  to.base_color = TextureId{from.base_color()};
  to.index_of_refraction = from.index_of_refraction();
  to.roughness = decode(from.roughness());
  to.anisotropic = decode(from.anisotropic());
  to.metallic = decode(from.metallic());
  to.spec_trans = decode(from.spec_trans());
  to.spec_tint = decode(from.spec_tint());
  to.sheen = decode(from.sheen());
  to.sheen_tint = decode(from.sheen_tint());
  to.flatness = decode(from.flatness());
  to.clearcoat = decode(from.clearcoat());
  to.clearcoat_gloss = decode(from.clearcoat_gloss());
  return to;
}

void encode_thin_principled(const ThinPrincipled& from, package::ThinPrincipled& to) {
  to.set_base_color(number_of(from.base_color));
  to.set_index_of_refraction(from.index_of_refraction);
  encode(from.roughness, *to.mutable_roughness());
  encode(from.anisotropic, *to.mutable_anisotropic());
  encode(from.spec_trans, *to.mutable_spec_trans());
  encode(from.spec_tint, *to.mutable_spec_tint());
  encode(from.sheen, *to.mutable_sheen());
  encode(from.sheen_tint, *to.mutable_sheen_tint());
  encode(from.flatness, *to.mutable_flatness());
  encode(from.diff_trans, *to.mutable_diff_trans());
}

ThinPrincipled decode_thin_principled(const package::ThinPrincipled& from) {
  ThinPrincipled to;
  to.base_color = TextureId{from.base_color()};
  to.index_of_refraction = from.index_of_refraction();
  to.roughness = decode(from.roughness());
  to.anisotropic = decode(from.anisotropic());
  to.spec_trans = decode(from.spec_trans());
  to.spec_tint = decode(from.spec_tint());
  to.sheen = decode(from.sheen());
  to.sheen_tint = decode(from.sheen_tint());
  to.flatness = decode(from.flatness());
  to.diff_trans = decode(from.diff_trans());
  return to;
}

}  // namespace bandsaw
