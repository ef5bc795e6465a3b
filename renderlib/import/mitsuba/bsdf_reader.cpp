// Converts one bsdf of a Mitsuba scene. read_kind() calls the function for the bsdf's type. This
// function sets the fields of a material of a Bandsaw scene file. Wrappers around a bsdf are in
// bsdf_wrappers.cpp, principled materials in principled_bsdfs.cpp.

#include "renderlib/import/mitsuba/bsdf_reader.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/spectra.h"

namespace bandsaw::mitsuba {

absl::Status BsdfReader::read(const Object& bsdf, Draft& draft) {
  const Parameters from(bsdf);
  RETURN_IF_ERROR(read_kind(from, draft));
  to_.warn_of_unused(from);
  return absl::OkStatus();
}

absl::Status BsdfReader::read_kind(const Parameters& from, Draft& draft) {
  using Read = absl::Status (BsdfReader::*)(const Parameters&, Draft&);
  static const std::map<std::string, Read> kinds = {
      {"diffuse", &BsdfReader::diffuse},
      {"roughdiffuse", &BsdfReader::diffuse},
      {"dielectric", &BsdfReader::dielectric},
      {"roughdielectric", &BsdfReader::dielectric},
      {"thindielectric", &BsdfReader::thin_dielectric},
      {"conductor", &BsdfReader::conductor},
      {"roughconductor", &BsdfReader::conductor},
      {"plastic", &BsdfReader::plastic},
      {"roughplastic", &BsdfReader::plastic},
      {"pplastic", &BsdfReader::plastic},
      {"principled", &BsdfReader::principled},
      {"principledthin", &BsdfReader::thin_principled},
      {"difftrans", &BsdfReader::diffuse_transmission},
      {"phong", &BsdfReader::phong},
      {"ward", &BsdfReader::ward},
      {"twosided", &BsdfReader::two_sided},
      {"mask", &BsdfReader::mask},
      {"normalmap", &BsdfReader::normal_map},
      {"bumpmap", &BsdfReader::bump_map},
      {"coating", &BsdfReader::coating},
      {"roughcoating", &BsdfReader::coating}};
  const auto kind = kinds.find(from.object().type);
  if (kind != kinds.end()) {
    return (this->*kind->second)(from, draft);
  }
  to_.warn(from.place(), absl::StrCat("bsdf \"", from.object().type,
                                      "\" is not known; grey diffuse stands in its place"));
  set_color(gray(0.5f), draft.material.mutable_diffuse()->mutable_color());
  return absl::OkStatus();
}

absl::Status BsdfReader::color_or_texture(const Parameters& from, const std::string& name,
                                          const std::function<scene::Color*()>& color,
                                          const std::function<scene::Texture*()>& texture) {
  const Property* property = from.find(name);
  if (property == nullptr) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> constant, constant_color(*property, ColorOf::kSurface));
  if (constant) {
    const auto bounded = [](float c) { return std::clamp(c, 0.0f, 1.0f); };
    set_color({bounded(constant->r), bounded(constant->g), bounded(constant->b)}, color());
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(*texture(), texture_of(*property, ColorOf::kSurface, surface_, to_));
  return absl::OkStatus();
}

absl::Status BsdfReader::color_only(const Parameters& from, const std::string& name,
                                    const std::function<scene::Color*()>& color) {
  scene::Texture ignored;
  RETURN_IF_ERROR(color_or_texture(from, name, color, [&] { return &ignored; }));
  if (ignored.kind_case() != scene::Texture::KIND_NOT_SET) {
    to_.warn(from.find(name)->place, absl::StrCat("a texture of \"", name, "\" is left out"));
  }
  return absl::OkStatus();
}

absl::Status BsdfReader::diffuse(const Parameters& from, Draft& draft) {
  scene::Diffuse& to = *draft.material.mutable_diffuse();
  if (from.object().type == "roughdiffuse") {
    to_.warn(from.place(), "bsdf \"roughdiffuse\" is shown as \"diffuse\"");
    from.ignore({"alpha", "use_fast_approx"});
  }
  const char* name = from.has("reflectance") ? "reflectance" : "diffuse_reflectance";
  return color_or_texture(
      from, name, [&] { return to.mutable_color(); }, [&] { return to.mutable_texture(); });
}

absl::StatusOr<double> BsdfReader::relative_index(const Parameters& from, const char* inside,
                                                  Draft& draft) {
  ASSIGN_OR_RETURN(const double in, index_of_refraction(from, "int_ior", inside));
  ASSIGN_OR_RETURN(const double out, index_of_refraction(from, "ext_ior", "air"));
  draft.turned = in < out;  // The geometry is turned over if its outside is denser.
  return draft.turned ? out / in : in / out;
}

absl::StatusOr<scene::Microfacets> BsdfReader::microfacets(const Parameters& from,
                                                           double otherwise) {
  scene::Microfacets to;
  ASSIGN_OR_RETURN(const std::string distribution, from.text("distribution", "beckmann"));
  if (distribution != "ggx") {
    to.set_distribution(scene::Microfacets::DISTRIBUTION_BECKMANN);
  }
  if (distribution != "ggx" && distribution != "beckmann") {
    to_.warn(from.place(),
             absl::StrCat("distribution \"", distribution, "\" is shown as \"beckmann\""));
  }
  from.ignore({"sample_visible"});
  const bool is_anisotropic = from.has("alpha_u") || from.has("alpha_v");
  ASSIGN_OR_RETURN(Varying alpha, varying_of(from, is_anisotropic ? "alpha_u" : "alpha", otherwise,
                                             surface_, to_));
  to.set_alpha(std::clamp(alpha.value, 0.0, 1.0));
  if (alpha.texture) {
    *to.mutable_alpha_texture() = *std::move(alpha.texture);
  }
  if (is_anisotropic) {
    ASSIGN_OR_RETURN(Varying alpha_v, varying_of(from, "alpha_v", otherwise, surface_, to_));
    to.set_alpha_v(std::clamp(alpha_v.value, 0.0, 1.0));
    if (alpha_v.texture) {
      *to.mutable_alpha_v_texture() = *std::move(alpha_v.texture);
    }
  }
  return to;
}

absl::Status BsdfReader::dielectric(const Parameters& from, Draft& draft) {
  scene::Dielectric& to = *draft.material.mutable_dielectric();
  draft.transmits = true;
  ASSIGN_OR_RETURN(const double index, relative_index(from, "bk7", draft));
  to.set_index_of_refraction(std::clamp(index, 1.0, 5.0));
  if (from.object().type == "roughdielectric") {
    ASSIGN_OR_RETURN(*to.mutable_surface(), microfacets(from, 0.1));
  }
  return warn_of_tints(from);
}

absl::Status BsdfReader::warn_of_tints(const Parameters& from) {
  for (const char* name : {"specular_reflectance", "specular_transmittance"}) {
    const Property* property = from.find(name);
    if (property == nullptr) {
      continue;
    }
    ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*property, ColorOf::kSurface));
    if (!color || !(*color == gray(1))) {
      to_.warn(property->place, absl::StrCat("\"", name, "\" of glass is left out"));
    }
  }
  return absl::OkStatus();
}

absl::Status BsdfReader::thin_dielectric(const Parameters& from, Draft& draft) {
  scene::ThinDielectric& to = *draft.material.mutable_thin_dielectric();
  draft.transmits = true;
  ASSIGN_OR_RETURN(const double index, relative_index(from, "bk7", draft));
  draft.turned = false;  // a pane is the same on both sides
  to.set_index_of_refraction(std::clamp(index, 1.0, 5.0));
  // Some of Mitsuba's integrators do not count the passage through a pane towards max_depth.
  to.set_free_passage(to_.passages_are_free);
  RETURN_IF_ERROR(color_only(from, "specular_reflectance", [&] { return to.mutable_specular(); }));
  return color_only(from, "specular_transmittance", [&] { return to.mutable_transmission(); });
}

absl::Status BsdfReader::set_metal(const Parameters& from, scene::Conductor& to) {
  // In scenes of Mitsuba 0.x (`is_old`), a conductor without eta is copper.
  const bool is_copper = to_.is_old && !from.has("eta");
  ASSIGN_OR_RETURN(const std::string name, from.text("material", is_copper ? "Cu" : "none"));
  if (name != "none") {
    auto metal = metal_of(name);
    if (!metal.ok()) {
      to_.warn(from.place(),
               absl::StrCat("metal \"", name, "\" is not known; chromium stands in its place"));
      metal = metal_of("Cr");
    }
    set_color(metal->eta, to.mutable_eta());
    set_color(metal->k, to.mutable_k());
    return absl::OkStatus();
  }
  if (!from.has("eta")) {
    from.ignore({"k"});  // eta is 0: a mirror, whatever k is
    return absl::OkStatus();
  }
  set_color(gray(1), to.mutable_k());
  // eta is the real part of the index of refraction, k the imaginary part.
  for (const bool real : {true, false}) {
    const Property* property = from.find(real ? "eta" : "k");
    if (property == nullptr) {
      continue;
    }
    ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*property, ColorOf::kSurface));
    if (!color) {
      return error_at(property->place, "\"eta\" and \"k\" must not be textures");
    }
    const float least = real ? 1e-4f : 0;
    const auto bounded = [&](float c) { return std::clamp(c, least, 100.0f); };
    set_color({bounded(color->r), bounded(color->g), bounded(color->b)},
              real ? to.mutable_eta() : to.mutable_k());
  }
  return absl::OkStatus();
}

absl::Status BsdfReader::conductor(const Parameters& from, Draft& draft) {
  scene::Conductor& to = *draft.material.mutable_conductor();
  RETURN_IF_ERROR(set_metal(from, to));
  from.ignore({"ext_eta"});
  if (from.object().type == "roughconductor") {
    ASSIGN_OR_RETURN(*to.mutable_surface(), microfacets(from, 0.1));
  }
  return color_or_texture(
      from, "specular_reflectance", [&] { return to.mutable_specular(); },
      [&] { return to.mutable_specular_texture(); });
}

absl::Status BsdfReader::plastic(const Parameters& from, Draft& draft) {
  scene::Plastic& to = *draft.material.mutable_plastic();
  ASSIGN_OR_RETURN(const double index, relative_index(from, "polypropylene", draft));
  if (draft.turned) {
    return error_at(from.place(), "int_ior of plastic must be above ext_ior");
  }
  to.set_index_of_refraction(std::clamp(index, 1.0001, 5.0));
  if (from.object().type == "roughplastic") {
    ASSIGN_OR_RETURN(*to.mutable_surface(), microfacets(from, 0.1));
    if (to.surface().has_alpha_v()) {
      to_.warn(from.place(), "plastic is shown with alpha_u in both directions");
      to.mutable_surface()->clear_alpha_v();
      to.mutable_surface()->clear_alpha_v_texture();
    }
  }
  if (from.object().type == "pplastic") {
    to_.warn(from.place(), "bsdf \"pplastic\" is shown as smooth plastic");
    from.ignore({"alpha", "alpha_u", "alpha_v", "distribution", "sample_visible"});
  }
  ASSIGN_OR_RETURN(const bool nonlinear, from.boolean("nonlinear", false));
  to.set_nonlinear(nonlinear);
  RETURN_IF_ERROR(color_only(from, "specular_reflectance", [&] { return to.mutable_specular(); }));
  return color_or_texture(
      from, "diffuse_reflectance", [&] { return to.mutable_color(); },
      [&] { return to.mutable_texture(); });
}

absl::Status BsdfReader::diffuse_transmission(const Parameters& from, Draft& draft) {
  scene::DiffuseTransmission& to = *draft.material.mutable_diffuse_transmission();
  draft.transmits = true;
  set_color({}, to.mutable_reflectance());
  set_color(gray(0.5f), to.mutable_transmittance());
  return color_or_texture(
      from, "transmittance", [&] { return to.mutable_transmittance(); },
      [&] { return to.mutable_transmittance_texture(); });
}

absl::Status BsdfReader::highlight(const Parameters& from, double alpha, Draft& draft) {
  scene::Plastic& to = *draft.material.mutable_plastic();
  to_.warn(from.place(), absl::StrCat("bsdf \"", from.object().type,
                                      "\" is shown as rough plastic with alpha ", alpha));
  to.mutable_surface()->set_alpha(std::clamp(alpha, 0.0, 1.0));
  from.ignore({"specular_reflectance", "variant"});
  return color_or_texture(
      from, "diffuse_reflectance", [&] { return to.mutable_color(); },
      [&] { return to.mutable_texture(); });
}

absl::Status BsdfReader::phong(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Varying exponent, varying_of(from, "exponent", 30, surface_, to_));
  // The alpha of the Beckmann lobe that is as wide at its peak as the Phong lobe (Walter et al.
  // 2007, section 5.3).
  return highlight(from, std::sqrt(2 / (std::max(exponent.value, 0.0) + 2)), draft);
}

absl::Status BsdfReader::ward(const Parameters& from, Draft& draft) {
  ASSIGN_OR_RETURN(const Varying alpha,
                   varying_of(from, from.has("alpha") ? "alpha" : "alpha_u", 0.1, surface_, to_));
  from.ignore({"alpha_v"});
  return highlight(from, alpha.value, draft);
}

}  // namespace bandsaw::mitsuba
