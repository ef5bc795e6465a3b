// Converts each kind of material to and from its message in proto/package.proto.

#include "renderlib/package/materials.h"

#include "renderlib/base/status_macros.h"
#include "renderlib/package/decode_enum.h"
#include "renderlib/package/manifest.h"
#include "renderlib/package/material_parts.h"
#include "renderlib/package/metallic_roughness.h"
#include "renderlib/package/principled.h"

namespace bandsaw {
namespace {

using bandsaw::decode;
using bandsaw::encode;

void encode(const Rgb& from, google::protobuf::RepeatedField<float>& to) {
  for (const float channel : {from.r, from.g, from.b}) {
    to.Add(channel);
  }
}

void encode(const Microfacets& from, package::Microfacets& to) {
  // The enums are declared in the same order.
  to.set_distribution(static_cast<std::uint32_t>(from.distribution));
  to.set_masking(static_cast<std::uint32_t>(from.masking));
  to.set_alpha_u(from.alpha_u);
  to.set_alpha_v(from.alpha_v);
  if (from.alpha_u_map) {
    to.set_alpha_u_texture(number_of(*from.alpha_u_map));
  }
  if (from.alpha_v_map) {
    to.set_alpha_v_texture(number_of(*from.alpha_v_map));
  }
}

/// Encodes the kind of a material into `to`; called by std::visit.
struct EncodeKind {
  package::Material& to;

  void operator()(const Diffuse& m) const {
    to.mutable_diffuse()->set_reflectance(number_of(m.reflectance));
  }
  void operator()(const Metal& m) const {
    to.mutable_metal()->set_reflectance(number_of(m.reflectance));
    to.mutable_metal()->set_fuzz(m.fuzz);
    if (m.fuzz_map) {
      to.mutable_metal()->set_fuzz_texture(number_of(*m.fuzz_map));
    }
  }
  void operator()(const Dielectric& m) const {
    to.mutable_dielectric()->set_index_of_refraction(m.index_of_refraction);
    to.mutable_dielectric()->set_roughness(m.roughness);
    to.mutable_dielectric()->set_priority(m.priority);
    if (m.surface) {
      encode(*m.surface, *to.mutable_dielectric()->mutable_surface());
    }
    if (m.roughness_map) {
      to.mutable_dielectric()->set_roughness_texture(number_of(*m.roughness_map));
    }
    if (m.index_map) {
      to.mutable_dielectric()->set_index_texture(number_of(*m.index_map));
    }
  }
  void operator()(const Emissive& m) const {
    to.mutable_emissive()->set_radiance(number_of(m.radiance));
    to.mutable_emissive()->set_one_sided(m.one_sided);
    to.mutable_emissive()->set_hidden(m.hidden);
  }
  void operator()(const MetallicRoughness& m) const {
    encode_metallic_roughness(m, *to.mutable_gltf());
  }
  void operator()(const Plastic& m) const {
    package::Plastic& plastic = *to.mutable_plastic();
    plastic.set_reflectance(number_of(m.reflectance));
    plastic.set_index_of_refraction(m.index_of_refraction);
    encode(m.surface, *plastic.mutable_surface());
    encode(m.specular, *plastic.mutable_specular());
    plastic.set_nonlinear(m.nonlinear);
  }
  void operator()(const Conductor& m) const {
    package::Conductor& conductor = *to.mutable_conductor();
    if (m.index) {
      encode(m.index->eta, *conductor.mutable_eta());
      encode(m.index->k, *conductor.mutable_k());
    }
    encode(m.surface, *conductor.mutable_surface());
    conductor.set_specular(number_of(m.specular));
  }
  void operator()(const ThinDielectric& m) const {
    package::ThinDielectric& pane = *to.mutable_thin_dielectric();
    pane.set_index_of_refraction(m.index_of_refraction);
    encode(m.specular, *pane.mutable_specular());
    encode(m.transmission, *pane.mutable_transmission());
    pane.set_free_passage(m.free_passage);
  }
  void operator()(const DiffuseTransmission& m) const {
    to.mutable_diffuse_transmission()->set_reflectance(number_of(m.reflectance));
    to.mutable_diffuse_transmission()->set_transmittance(number_of(m.transmittance));
  }
  void operator()(const Principled& m) const { encode_principled(m, *to.mutable_principled()); }
  void operator()(const ThinPrincipled& m) const {
    encode_thin_principled(m, *to.mutable_thin_principled());
  }
  void operator()(const Mix& m) const {
    to.mutable_mix()->set_a(static_cast<std::uint32_t>(m.a));
    to.mutable_mix()->set_b(static_cast<std::uint32_t>(m.b));
    to.mutable_mix()->set_amount(number_of(m.amount));
  }
};

void encode(const Relief& from, package::Relief& to) {
  if (from.normal) {
    to.set_normal(number_of(*from.normal));
  }
  to.set_normal_scale(from.normal_scale);
  if (from.height) {
    to.set_height(number_of(*from.height));
  }
  to.set_height_scale(from.height_scale);
}

void encode(const Alpha& from, package::Alpha& to) {
  // The enums are declared in the same order.
  to.set_mode(static_cast<package::Alpha::Mode>(from.mode));
  encode(from.value, *to.mutable_value());
  to.set_luminance(from.luminance);
  to.set_cutoff(from.cutoff);
}

Relief decode(const package::Relief& from) {
  return {texture_if(from.has_normal(), from.normal()), from.normal_scale(),
          texture_if(from.has_height(), from.height()), from.height_scale()};
}

absl::StatusOr<Alpha> decode(const package::Alpha& from, const std::string& field) {
  Alpha to;
  ASSIGN_OR_RETURN(to.mode,
                   decode_enum<AlphaMode>(from.mode(), /*first=*/0, /*last=*/2, field + ".mode"));
  to.value = decode(from.value());
  to.luminance = from.luminance();
  to.cutoff = from.cutoff();
  return to;
}

Metal decode(const package::Metal& from) {
  return {TextureId{from.reflectance()}, from.fuzz(),
          texture_if(from.has_fuzz_texture(), from.fuzz_texture())};
}

absl::StatusOr<Microfacets> decode(const package::Microfacets& from, const std::string& field) {
  Microfacets to;
  ASSIGN_OR_RETURN(to.distribution, decode_enum<Microfacets::Distribution>(
                                        static_cast<int>(from.distribution()),
                                        /*first=*/0, /*last=*/1, field + ".distribution"));
  ASSIGN_OR_RETURN(to.masking,
                   decode_enum<Microfacets::Masking>(static_cast<int>(from.masking()),
                                                     /*first=*/0, /*last=*/1, field + ".masking"));
  to.alpha_u = from.alpha_u();
  to.alpha_v = from.alpha_v();
  to.alpha_u_map = texture_if(from.has_alpha_u_texture(), from.alpha_u_texture());
  to.alpha_v_map = texture_if(from.has_alpha_v_texture(), from.alpha_v_texture());
  return to;
}

absl::StatusOr<Dielectric> decode(const package::Dielectric& from, const std::string& field) {
  Dielectric to{from.index_of_refraction(), from.roughness(), from.priority(),
                texture_if(from.has_roughness_texture(), from.roughness_texture()),
                texture_if(from.has_index_texture(), from.index_texture())};
  if (from.has_surface()) {
    ASSIGN_OR_RETURN(to.surface, decode(from.surface(), field + ".surface"));
  }
  return to;
}

absl::StatusOr<Plastic> decode(const package::Plastic& from, const std::string& field) {
  Plastic to{TextureId{from.reflectance()}, from.index_of_refraction()};
  ASSIGN_OR_RETURN(to.surface, decode(from.surface(), field + ".surface"));
  ASSIGN_OR_RETURN(to.specular, decode_rgb(from.specular(), field + ".specular"));
  to.nonlinear = from.nonlinear();
  return to;
}

absl::StatusOr<Conductor> decode(const package::Conductor& from, const std::string& field) {
  Conductor to;
  if (from.eta_size() > 0 || from.k_size() > 0) {
    ConductorIndex index;
    ASSIGN_OR_RETURN(index.eta, decode_rgb(from.eta(), field + ".eta"));
    ASSIGN_OR_RETURN(index.k, decode_rgb(from.k(), field + ".k"));
    to.index = index;
  }
  ASSIGN_OR_RETURN(to.surface, decode(from.surface(), field + ".surface"));
  to.specular = TextureId{from.specular()};
  return to;
}

absl::StatusOr<ThinDielectric> decode(const package::ThinDielectric& from,
                                      const std::string& field) {
  ThinDielectric to{from.index_of_refraction()};
  ASSIGN_OR_RETURN(to.specular, decode_rgb(from.specular(), field + ".specular"));
  ASSIGN_OR_RETURN(to.transmission, decode_rgb(from.transmission(), field + ".transmission"));
  to.free_passage = from.free_passage();
  return to;
}

absl::StatusOr<Material> decode_kind(const package::Material& from, const std::string& field) {
  switch (from.kind_case()) {
    case package::Material::kDiffuse:
      return Diffuse{TextureId{from.diffuse().reflectance()}};
    case package::Material::kMetal:
      return decode(from.metal());
    case package::Material::kDielectric:
      return decode(from.dielectric(), field + ".dielectric");
    case package::Material::kEmissive:
      return Emissive{TextureId{from.emissive().radiance()}, from.emissive().one_sided(),
                      from.emissive().hidden()};
    case package::Material::kGltf:
      return decode_metallic_roughness(from.gltf(), field + ".gltf");
    case package::Material::kPlastic:
      return decode(from.plastic(), field + ".plastic");
    case package::Material::kConductor:
      return decode(from.conductor(), field + ".conductor");
    case package::Material::kThinDielectric:
      return decode(from.thin_dielectric(), field + ".thin_dielectric");
    case package::Material::kDiffuseTransmission:
      return DiffuseTransmission{TextureId{from.diffuse_transmission().reflectance()},
                                 TextureId{from.diffuse_transmission().transmittance()}};
    case package::Material::kPrincipled:
      return decode_principled(from.principled());
    case package::Material::kThinPrincipled:
      return decode_thin_principled(from.thin_principled());
    case package::Material::kMix:
      return Mix{MaterialId{from.mix().a()}, MaterialId{from.mix().b()},
                 TextureId{from.mix().amount()}};
    case package::Material::KIND_NOT_SET:
      break;
  }
  return manifest_error(field, "is of no kind that this program knows");
}

}  // namespace

void encode_material(const Material& from, package::Material& to) {
  std::visit(EncodeKind{to}, from.kind);
  if (from.relief.normal || from.relief.height) {
    encode(from.relief, *to.mutable_relief());
  }
  if (from.alpha.mode != AlphaMode::kOpaque) {
    encode(from.alpha, *to.mutable_alpha());
  }
  if (!is_black(from.emission.radiance.factor)) {
    encode(from.emission.radiance, *to.mutable_emission()->mutable_radiance());
    to.mutable_emission()->set_one_sided(from.emission.one_sided);
  }
  to.set_one_sided(from.one_sided);
}

absl::StatusOr<Material> decode_material(const package::Material& from, const std::string& field) {
  ASSIGN_OR_RETURN(Material to, decode_kind(from, field));
  if (from.has_relief()) {
    to.relief = decode(from.relief());
  }
  if (from.has_alpha()) {
    ASSIGN_OR_RETURN(to.alpha, decode(from.alpha(), field + ".alpha"));
  }
  if (from.has_emission()) {
    ASSIGN_OR_RETURN(to.emission.radiance,
                     decode(from.emission().radiance(), field + ".emission.radiance"));
    to.emission.one_sided = from.emission().one_sided();
  }
  to.one_sided = from.one_sided();
  return to;
}

}  // namespace bandsaw
