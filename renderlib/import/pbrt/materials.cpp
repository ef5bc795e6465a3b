// Converts pbrt's materials: one function for each kind (metals are in metals.cpp), then the normal
// map and the displacement, which every kind can have.

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/import/pbrt/material_source.h"
#include "renderlib/import/pbrt/metals.h"

namespace bandsaw::pbrt {
namespace {

/// Writes a constant colour to the field color(message), and any other texture to the field
/// other(message).
void set_color_or_texture(scene::Texture texture, scene::Color* (*color)(void*),
                          scene::Texture* (*other)(void*), void* message) {
  if (texture.has_color()) {
    *color(message) = std::move(*texture.mutable_color());
  } else {
    *other(message) = std::move(texture);
  }
}

/// Writes `texture` to the field `color` or `texture` of `to`.
template <class Message>
void set_reflectance(scene::Texture texture, Message& to) {
  set_color_or_texture(
      std::move(texture), [](void* m) { return static_cast<Message*>(m)->mutable_color(); },
      [](void* m) { return static_cast<Message*>(m)->mutable_texture(); }, &to);
}

absl::Status diffuse(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.5));
  to.is_black = constant_of(reflectance) == 0.0;
  set_reflectance(std::move(reflectance), *to.material.mutable_diffuse());
  return absl::OkStatus();
}

absl::Status coated_diffuse(const MaterialSource& from, Surface& to) {
  scene::Plastic& plastic = *to.material.mutable_plastic();
  ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.5));
  set_reflectance(std::move(reflectance), plastic);
  ASSIGN_OR_RETURN(const Roughness roughness, read_roughness(from, "", 0));
  if (!roughness.is_smooth()) {
    set_microfacets(roughness, plastic.mutable_surface());
    if (roughness.alpha[0] != roughness.alpha[1]) {
      plastic.mutable_surface()->set_alpha(roughness.mean());
      plastic.mutable_surface()->clear_alpha_v();
      from.builder.warn(from.place(),
                        "the coat's roughness is the mean of the roughness along u and v");
    }
  }
  ASSIGN_OR_RETURN(const double index, read_index(from, "eta", 1.5));
  plastic.set_index_of_refraction(std::max(index, 1.0001));
  plastic.set_nonlinear(true);
  const Parameter* albedo = from.parameters.find("albedo");
  if (albedo != nullptr) {
    from.builder.warn(albedo->place, "the coat is clear: its albedo has no counterpart");
  }
  from.parameters.ignore({"thickness", "g", "maxdepth", "nsamples"});
  return absl::OkStatus();
}

absl::Status dielectric(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const Roughness roughness, read_roughness(from, "", 0));
  ASSIGN_OR_RETURN(const double index, read_index(from, "eta", 1.5));
  scene::Dielectric& glass = *to.material.mutable_dielectric();
  glass.set_index_of_refraction(index);
  if (!roughness.is_smooth()) {
    set_microfacets(roughness, glass.mutable_surface());
  }
  to.transmits = true;
  return absl::OkStatus();
}

absl::Status thin_dielectric(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const double index, read_index(from, "eta", 1.5));
  to.material.mutable_thin_dielectric()->set_index_of_refraction(index);
  to.transmits = true;
  return absl::OkStatus();
}

absl::Status diffuse_transmission(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.25));
  ASSIGN_OR_RETURN(scene::Texture transmittance, from.reflectance("transmittance", 0.25));
  ASSIGN_OR_RETURN(const double scale, from.parameters.number("scale", 1));
  const auto scaled = [&](scene::Texture texture) {
    if (scale == 1) {
      return texture;
    }
    const double factor = std::clamp(scale, 0.0, 1.0);
    if (texture.has_color()) {
      for (int c = 0; c < 3; ++c) {
        texture.mutable_color()->set_rgb(c, texture.color().rgb(c) * factor);
      }
      return texture;
    }
    scene::Texture out;
    *out.mutable_product()->mutable_a() = std::move(texture);
    *out.mutable_product()->mutable_b() = constant_texture({factor, factor, factor});
    return out;
  };
  scene::DiffuseTransmission& out = *to.material.mutable_diffuse_transmission();
  reflectance = scaled(std::move(reflectance));
  transmittance = scaled(std::move(transmittance));
  if (reflectance.has_color() && transmittance.has_color()) {
    // In pbrt the sum may exceed 1. The factor 0.9999999 keeps the scaled sum from exceeding
    // 1 by rounding.
    bool is_bright = false;
    for (int c = 0; c < 3; ++c) {
      const double sum = reflectance.color().rgb(c) + transmittance.color().rgb(c);
      if (sum > 1) {
        is_bright = true;
        reflectance.mutable_color()->set_rgb(c, reflectance.color().rgb(c) / sum * 0.9999999);
        transmittance.mutable_color()->set_rgb(c, transmittance.color().rgb(c) / sum * 0.9999999);
      }
    }
    if (is_bright) {
      from.builder.warn(from.place(),
                        "reflectance and transmittance exceed 1 together and are scaled to 1");
    }
  }
  if (reflectance.has_color()) {
    *out.mutable_reflectance() = std::move(*reflectance.mutable_color());
  } else {
    *out.mutable_reflectance_texture() = std::move(reflectance);
  }
  if (transmittance.has_color()) {
    *out.mutable_transmittance() = std::move(*transmittance.mutable_color());
  } else {
    *out.mutable_transmittance_texture() = std::move(transmittance);
  }
  to.transmits = true;
  return absl::OkStatus();
}

/// Converts a mix of two named materials. If one of the two cannot be part of a mix, the result is
/// the other material alone, with a warning.
absl::Status mix(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const std::vector<std::string> names, from.parameters.texts("materials"));
  if (names.size() != 2) {
    return error_at(from.place(), "a mix needs \"string materials\" with two names");
  }
  for (const std::string& name : names) {
    if (!from.builder.materials.contains(name)) {
      return error_at(from.place(), absl::StrCat("no material is called \"", name, "\""));
    }
  }
  ASSIGN_OR_RETURN(auto amount, float_texture(from.parameters, "amount", from.builder));
  scene::MixMaterial& out = *to.material.mutable_mix();
  std::string parts[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const Surface& surface = *from.builder.materials.find(names[i])->second;
    if (surface.is_null || surface.material.has_mix()) {
      from.builder.warn(
          from.place(),
          absl::StrCat("\"", names[i], "\" cannot be mixed; the other material is shown alone"));
      const std::string label = to.label;
      to = *from.builder.materials.find(names[1 - i])->second;
      to.label = label;
      return absl::OkStatus();
    }
    to.transmits = to.transmits || surface.transmits;
    parts[i] = material_name(surface, {}, from.place(), from.builder);
  }
  out.set_a(parts[0]);
  out.set_b(parts[1]);
  if (amount) {
    ASSIGN_OR_RETURN(*out.mutable_amount(),
                     limited(*std::move(amount), from.place(), from.builder));
  }
  return absl::OkStatus();
}

/// Marks all parameters as used, so that none of them causes a further warning.
void use_all(const MaterialSource& from) {
  for (const Parameter& parameter : from.parameters.list) {
    parameter.is_used = true;
  }
}

/// Converts a material of the kind `type`. A kind without a counterpart becomes a diffuse or coated
/// diffuse surface, with a warning.
absl::Status read_kind(const MaterialSource& from, const std::string& type, Surface& to) {
  using Reader = absl::Status (*)(const MaterialSource&, Surface&);
  constexpr std::pair<const char*, Reader> kReaders[] = {
      {"diffuse", diffuse},
      {"coateddiffuse", coated_diffuse},
      {"conductor", conductor},
      {"coatedconductor", coated_conductor},
      {"dielectric", dielectric},
      {"thindielectric", thin_dielectric},
      {"diffusetransmission", diffuse_transmission},
      {"mix", mix}};
  for (const auto& [name, read] : kReaders) {
    if (type == name) {
      return read(from, to);
    }
  }
  if (type == "interface" || type.empty() || type == "none") {
    to.is_null = true;
    to.transmits = true;
    return absl::OkStatus();
  }
  const char* instead = type == "subsurface" ? "a coateddiffuse surface" : "a diffuse surface";
  from.builder.warn(from.place(), absl::StrCat("the material \"", type, "\" has no counterpart; ",
                                               instead, " stands for it"));
  const absl::Status status = type == "subsurface" ? coated_diffuse(from, to) : diffuse(from, to);
  use_all(from);
  return status;
}

/// Reads a normal map and a displacement.
absl::Status read_bumps(const MaterialSource& from, Surface& to) {
  // True if the material may have the fields normal_texture and bump_texture. A mix and glTF's
  // material may not have them, but glTF's material has a field of its own for a normal map.
  const bool has_fields = !to.material.has_mix() && !to.material.has_gltf() && !to.is_null;
  ASSIGN_OR_RETURN(const std::string normals, from.parameters.text("normalmap", ""));
  if (!normals.empty()) {
    ASSIGN_OR_RETURN(const auto bytes,
                     read_or_warn(normals, from.place(), "the surface is smooth", from.builder));
    if (bytes) {
      scene::Texture* texture = to.material.has_gltf()
                                    ? to.material.mutable_gltf()->mutable_normal_texture()
                                : has_fields ? to.material.mutable_normal_texture()
                                             : nullptr;
      if (texture == nullptr) {
        from.builder.warn(from.place(), "the normal map is left out");
        return absl::OkStatus();
      }
      texture->mutable_image()->set_file(normals);
      texture->mutable_image()->set_encoding(scene::ImageTexture::ENCODING_LINEAR);
    }
  }
  ASSIGN_OR_RETURN(auto heights, float_texture(from.parameters, "displacement", from.builder));
  if (!heights || constant_of(*heights)) {
    return absl::OkStatus();
  }
  if (!has_fields || to.material.has_normal_texture()) {
    from.builder.warn(from.place(), "the displacement is left out");
    return absl::OkStatus();
  }
  *to.material.mutable_bump_texture() = *std::move(heights);
  to.material.set_bump_scale(1);
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::shared_ptr<const Surface>> make_surface(const std::string& type,
                                                            const std::string& label,
                                                            const Parameters& parameters,
                                                            const State& state, Builder& builder) {
  auto surface = std::make_shared<Surface>();
  surface->label = label;
  const MaterialSource from{parameters, state, builder};
  RETURN_IF_ERROR(read_kind(from, type, *surface));
  RETURN_IF_ERROR(read_bumps(from, *surface));
  builder.warn_of_unused(parameters);
  return std::shared_ptr<const Surface>(std::move(surface));
}

}  // namespace bandsaw::pbrt
