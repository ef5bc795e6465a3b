// Materials.

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {
namespace {

/// pbrt treats smaller values of alpha as smooth.
constexpr double kSmooth = 1e-3;

struct MaterialSource {
  const Parameters& parameters;
  const State& state;
  Builder& builder;

  const Place& place() const { return parameters.place; }
  absl::StatusOr<scene::Texture> reflectance(const std::string& name, double otherwise) const {
    return color_texture(parameters, name, ColorUse::kReflectance,
                         {otherwise, otherwise, otherwise}, state, builder);
  }
};

/// Sets a texture, or a colour if it is constant.
void set_color_or_texture(scene::Texture texture, scene::Color* (*color)(void*),
                          scene::Texture* (*other)(void*), void* message) {
  if (texture.has_color()) {
    *color(message) = std::move(*texture.mutable_color());
  } else {
    *other(message) = std::move(texture);
  }
}

template <class Message>
void set_reflectance(scene::Texture texture, Message& to) {
  set_color_or_texture(
      std::move(texture), [](void* m) { return static_cast<Message*>(m)->mutable_color(); },
      [](void* m) { return static_cast<Message*>(m)->mutable_texture(); }, &to);
}

/// Roughness along u and v.
struct Roughness {
  double alpha[2] = {0, 0};
  std::optional<scene::Texture> texture;  ///< of alpha, if it varies
  bool is_smooth() const { return !texture && std::max(alpha[0], alpha[1]) < kSmooth; }
  double mean() const { return texture ? 1 : (alpha[0] + alpha[1]) / 2; }
};

/// Reads PREFIXroughness, uroughness and vroughness.
absl::StatusOr<Roughness> read_roughness(const MaterialSource& from, const std::string& prefix,
                                         double otherwise) {
  const Parameters& in = from.parameters;
  ASSIGN_OR_RETURN(const bool remap, in.boolean("remaproughness", true));
  ASSIGN_OR_RETURN(const auto both, float_texture(in, prefix + "roughness", from.builder));
  Roughness out;
  const char* names[2] = {"uroughness", "vroughness"};
  for (int k = 0; k < 2; ++k) {
    ASSIGN_OR_RETURN(auto own, float_texture(in, prefix + names[k], from.builder));
    const std::optional<scene::Texture>& texture = own ? own : both;
    const auto value = texture ? constant_of(*texture) : std::optional(otherwise);
    if (!value) {
      out.texture = texture;
      continue;
    }
    out.alpha[k] = std::clamp(remap ? std::sqrt(std::max(*value, 0.0)) : *value, 0.0, 1.0);
  }
  if (out.texture && remap) {
    from.builder.warn_once(from.place(),
                           "textures of roughness are taken as alpha, without remaproughness");
  }
  return out;
}

void set_microfacets(const Roughness& roughness, scene::Microfacets* to) {
  to->set_distribution(scene::Microfacets::DISTRIBUTION_GGX);
  to->set_masking(scene::Microfacets::MASKING_CORRELATED);
  if (roughness.texture) {
    to->set_alpha(1);
    *to->mutable_alpha_texture() = *roughness.texture;
    return;
  }
  to->set_alpha(roughness.alpha[0]);
  if (roughness.alpha[1] != roughness.alpha[0]) {
    to->set_alpha_v(roughness.alpha[1]);
  }
}

/// Returns the index of refraction: a number, or a glass at the d line.
absl::StatusOr<double> read_index(const MaterialSource& from, const std::string& name, double otherwise) {
  const Parameter* found = from.parameters.find(name);
  if (found == nullptr || found->type == "float") {
    ASSIGN_OR_RETURN(const double index, from.parameters.number(name, otherwise));
    if (!(index >= 1 && index <= 5)) {
      from.builder.warn(from.place(), absl::StrCat("the index of refraction ", index,
                                                   " is taken as ", std::clamp(index, 1.0, 5.0)));
    }
    return std::clamp(index, 1.0, 5.0);
  }
  if (found->type != "spectrum") {
    ASSIGN_OR_RETURN(const Rgb3 rgb, color_of(*found, ColorUse::kUnbounded, "srgb", from.builder));
    return std::clamp(spectrum::luminance(rgb), 1.0, 5.0);
  }
  ASSIGN_OR_RETURN(const auto sampled, spectrum_of(*found, from.builder));
  from.builder.warn_once(found->place,
                         "the index of refraction is that at 588 nm: there is no dispersion");
  return std::clamp(sampled->at(spectrum::kLineD), 1.0, 5.0);
}

/// Returns eta and k of a conductor by PREFIXeta and PREFIXk; copper by default.
absl::StatusOr<spectrum::Metal> read_metal(const MaterialSource& from, const std::string& prefix) {
  const Parameter* eta = from.parameters.find(prefix + "eta");
  const Parameter* k = from.parameters.find(prefix + "k");
  std::optional<spectrum::Sampled> spectra[2] = {spectrum::named("metal-Cu-eta"),
                                                 spectrum::named("metal-Cu-k")};
  std::optional<Rgb3> colors[2];
  const Parameter* given[2] = {eta, k};
  for (int i = 0; i < 2; ++i) {
    if (given[i] == nullptr) {
      continue;
    }
    ASSIGN_OR_RETURN(spectra[i], spectrum_of(*given[i], from.builder));
    if (!spectra[i]) {
      ASSIGN_OR_RETURN(colors[i], color_of(*given[i], ColorUse::kUnbounded, from.state.color_space,
                                           from.builder));
    }
  }
  if (spectra[0] && spectra[1]) {
    return spectrum::metal_rgb(*spectra[0], *spectra[1]);
  }
  spectrum::Metal metal;
  metal.eta = colors[0] ? *colors[0] : spectrum::factor_rgb(*spectra[0]);
  metal.k = colors[1] ? *colors[1] : spectrum::factor_rgb(*spectra[1]);
  return metal;
}

/// Returns the reflectance of a metal at normal incidence in a medium of index `outside`.
Rgb3 reflectance_of(const spectrum::Metal& metal, double outside) {
  Rgb3 out = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const double n = metal.eta[c] / outside;
    const double k = metal.k[c] / outside;
    out[c] = ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
  }
  return out;
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
      from.builder.warn(from.place(), "the coat's roughness is the mean of that along u and v");
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

absl::Status conductor(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const Roughness roughness, read_roughness(from, "", 0));
  if (from.parameters.find("reflectance") != nullptr) {
    ASSIGN_OR_RETURN(scene::Texture reflectance, from.reflectance("reflectance", 0.5));
    if (!reflectance.has_color()) {
      from.builder.warn(from.place(), "the metal's reflectance is the texture at every angle");
      scene::Conductor& metal = *to.material.mutable_conductor();
      *metal.mutable_specular_texture() = std::move(reflectance);
      if (!roughness.is_smooth()) {
        set_microfacets(roughness, metal.mutable_surface());
      }
      return absl::OkStatus();
    }
    Rgb3 k = {};
    for (int c = 0; c < 3; ++c) {
      const double r = std::min(reflectance.color().rgb(c), 0.9999);
      k[static_cast<std::size_t>(c)] = std::min(2 * std::sqrt(r) / std::sqrt(1 - r), 100.0);
    }
    set_rgb({1, 1, 1}, to.material.mutable_conductor()->mutable_eta());
    set_rgb(k, to.material.mutable_conductor()->mutable_k());
  } else {
    ASSIGN_OR_RETURN(spectrum::Metal metal, read_metal(from, ""));
    for (std::size_t c = 0; c < 3; ++c) {
      metal.eta[c] = std::clamp(metal.eta[c], 1e-6, 100.0);
      metal.k[c] = std::clamp(metal.k[c], 0.0, 100.0);
    }
    set_rgb(metal.eta, to.material.mutable_conductor()->mutable_eta());
    set_rgb(metal.k, to.material.mutable_conductor()->mutable_k());
  }
  if (!roughness.is_smooth()) {
    set_microfacets(roughness, to.material.mutable_conductor()->mutable_surface());
  }
  return absl::OkStatus();
}

/// A metal under a clear coat: glTF's metal with clear coat stands for it.
absl::Status coated_conductor(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const Roughness coat, read_roughness(from, "interface.", 0));
  ASSIGN_OR_RETURN(const Roughness metal, read_roughness(from, "conductor.", 0));
  ASSIGN_OR_RETURN(const double index, read_index(from, "interface.eta", 1.5));
  Rgb3 color = {0.5, 0.5, 0.5};
  if (from.parameters.find("reflectance") != nullptr) {
    ASSIGN_OR_RETURN(const scene::Texture reflectance, from.reflectance("reflectance", 0.5));
    if (reflectance.has_color()) {
      for (int c = 0; c < 3; ++c) {
        color[static_cast<std::size_t>(c)] = reflectance.color().rgb(c);
      }
    }
  } else {
    ASSIGN_OR_RETURN(const spectrum::Metal measured, read_metal(from, "conductor."));
    color = reflectance_of(measured, index);
  }
  scene::Gltf& gltf = *to.material.mutable_gltf();
  set_rgb(color, gltf.mutable_base_color());
  gltf.set_metallic(1);
  gltf.set_roughness(std::sqrt(metal.mean()));
  gltf.set_clearcoat(1);
  gltf.set_clearcoat_roughness(std::sqrt(coat.mean()));
  from.builder.warn_once(from.place(),
                         "coatedconductor is shown as a metal with a clear coat of index 1.5, "
                         "without light that is reflected between the two");
  from.parameters.ignore(
      {"thickness", "interface.thickness", "g", "albedo", "maxdepth", "nsamples"});
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
    // pbrt lets the sum exceed 1.
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

absl::Status mix(const MaterialSource& from, Surface& to) {
  ASSIGN_OR_RETURN(const std::vector<std::string> names, from.parameters.texts("materials"));
  if (names.size() != 2) {
    return error_at(from.place(), "a mix needs \"string materials\" with two names");
  }
  ASSIGN_OR_RETURN(auto amount, float_texture(from.parameters, "amount", from.builder));
  scene::MixMaterial& out = *to.material.mutable_mix();
  std::string parts[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const auto part = from.builder.materials.find(names[i]);
    if (part == from.builder.materials.end()) {
      return error_at(from.place(), absl::StrCat("no material is called \"", names[i], "\""));
    }
    const Surface& surface = *part->second;
    if (surface.is_null || surface.material.has_mix()) {
      from.builder.warn(from.place(), absl::StrCat("\"", names[i],
                                                   "\" cannot be mixed; the other is shown alone"));
      const auto other = from.builder.materials.find(names[1 - i]);
      if (other != from.builder.materials.end()) {
        const std::string label = to.label;
        to = *other->second;
        to.label = label;
      }
      return absl::OkStatus();
    }
    to.transmits = to.transmits || surface.transmits;
    parts[i] = material_name(surface, {}, from.place(), from.builder);
  }
  out.set_a(parts[0]);
  out.set_b(parts[1]);
  if (amount) {
    *out.mutable_amount() = *std::move(amount);
  }
  return absl::OkStatus();
}

void use_all(const MaterialSource& from) {
  for (const Parameter& parameter : from.parameters.list) {
    parameter.is_used = true;
  }
}

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

namespace {

/// Adds what a shape emits.
void add_emission(const ShapeLook& look, const Surface& surface, const Place& place,
                  scene::Material& to, Builder& builder) {
  const Rgb3 emission = look.emission.value_or(Rgb3{0, 0, 0});
  if (surface.is_black && !look.opacity) {
    scene::Emissive& lamp = *to.mutable_emissive();
    lamp.set_one_sided(!look.emits_on_both_sides);
    if (look.emission_texture) {
      *lamp.mutable_texture() = *look.emission_texture;
    } else {
      set_rgb(emission, lamp.mutable_radiance());
    }
    return;
  }
  if (to.has_mix()) {
    builder.warn(place, "a mix of materials cannot emit; the shape is lit, but no light");
    return;
  }
  if (to.has_gltf()) {
    set_rgb(emission, to.mutable_gltf()->mutable_emissive());
    to.mutable_gltf()->set_double_sided(look.emits_on_both_sides);
    return;
  }
  if (look.emission_texture) {
    *to.mutable_emission_texture() = *look.emission_texture;
  } else {
    set_rgb(emission, to.mutable_emission());
  }
  to.set_emission_one_sided(!look.emits_on_both_sides);
}

void add_opacity(const scene::Texture& opacity, const Place& place, scene::Material& to,
                 Builder& builder) {
  if (to.has_mix() || to.has_emissive()) {
    builder.warn(place, "the alpha of the shape is left out");
    return;
  }
  const auto value = constant_of(opacity);
  if (to.has_gltf()) {
    to.mutable_gltf()->set_alpha_mode(scene::Gltf::ALPHA_MODE_BLEND);
    if (value) {
      to.mutable_gltf()->set_alpha(std::clamp(*value, 0.0, 1.0));
    } else {
      *to.mutable_gltf()->mutable_alpha_texture() = opacity;
    }
  } else if (value) {
    to.set_opacity(std::clamp(*value, 0.0, 1.0));
  } else {
    *to.mutable_opacity_texture() = opacity;
  }
}

}  // namespace

std::string material_name(const Surface& surface, const ShapeLook& look, const Place& place,
                          Builder& builder) {
  scene::Material material = surface.material;
  if (look.emission || look.emission_texture) {
    add_emission(look, surface, place, material, builder);
  }
  if (look.opacity) {
    add_opacity(*look.opacity, place, material, builder);
  }
  const std::string key = absl::StrCat(surface.label, "\n", material.SerializeAsString());
  const auto known = builder.material_names.find(key);
  if (known != builder.material_names.end()) {
    return known->second;
  }
  const std::string base = surface.label.empty() ? "material" : surface.label;
  std::string name = base;
  while (!builder.taken_names.insert(name).second) {
    name = absl::StrCat(base, "_", ++builder.name_counts[base] + 1);
  }
  material.set_name(name);
  *builder.out.add_material() = std::move(material);
  builder.material_names.emplace(key, name);
  return name;
}

}  // namespace bandsaw::pbrt
