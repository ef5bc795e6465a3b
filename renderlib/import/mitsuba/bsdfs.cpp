#include "renderlib/import/mitsuba/bsdfs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/spectra.h"

namespace bandsaw::mitsuba {
namespace {

const Object* object_in(const Property& property) {
  const auto* const* object = std::get_if<const Object*>(&property.value);
  return object != nullptr ? *object : nullptr;
}

/// Properties that wrappers around a bsdf give to it (twosided, mask, normalmap, bumpmap), and the
/// result so far.
struct Draft {
  scene::Material material;
  bool two_sided = false;
  bool turned = false;
  bool transmits = false;  ///< has no black side
};

class BsdfReader {
 public:
  BsdfReader(const TexturedSurface& surface, Conversion& to) : surface_(surface), to_(to) {}

  absl::Status read(const Object& bsdf, Draft& draft) {
    const Parameters from(bsdf);
    RETURN_IF_ERROR(read_kind(from, draft));
    to_.warn_of_unused(from);
    return absl::OkStatus();
  }

 private:
  absl::Status read_kind(const Parameters& from, Draft& draft) {
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

  /// Sets a colour, or a texture if it varies. Absent: the field stays unset.
  absl::Status color_or_texture(const Parameters& from, const std::string& name,
                                const std::function<scene::Color*()>& color,
                                const std::function<scene::Texture*()>& texture) {
    const Property* property = from.find(name);
    if (property == nullptr) {
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(const std::optional<Rgb> constant,
                     constant_color(*property, ColorOf::kSurface));
    if (constant) {
      const auto bounded = [](float c) { return std::clamp(c, 0.0f, 1.0f); };
      set_color({bounded(constant->r), bounded(constant->g), bounded(constant->b)}, color());
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(*texture(), texture_of(*property, ColorOf::kSurface, surface_, to_));
    return absl::OkStatus();
  }

  /// Sets a colour; of a texture, a warning and no colour.
  absl::Status color_only(const Parameters& from, const std::string& name,
                          const std::function<scene::Color*()>& color) {
    scene::Texture ignored;
    RETURN_IF_ERROR(color_or_texture(from, name, color, [&] { return &ignored; }));
    if (ignored.kind_case() != scene::Texture::KIND_NOT_SET) {
      to_.warn(from.find(name)->place, absl::StrCat("a texture of \"", name, "\" is left out"));
    }
    return absl::OkStatus();
  }

  absl::Status diffuse(const Parameters& from, Draft& draft) {
    scene::Diffuse& to = *draft.material.mutable_diffuse();
    if (from.object().type == "roughdiffuse") {
      to_.warn(from.place(), "bsdf \"roughdiffuse\" is shown as \"diffuse\"");
      from.ignore({"alpha", "use_fast_approx"});
    }
    const char* name = from.has("reflectance") ? "reflectance" : "diffuse_reflectance";
    return color_or_texture(
        from, name, [&] { return to.mutable_color(); }, [&] { return to.mutable_texture(); });
  }

  /// Returns the index of the inside divided by that of the outside; above 1, turned over if
  /// needed.
  absl::StatusOr<double> relative_index(const Parameters& from, const char* inside, Draft& draft) {
    ASSIGN_OR_RETURN(const double in, index_of_refraction(from, "int_ior", inside));
    ASSIGN_OR_RETURN(const double out, index_of_refraction(from, "ext_ior", "air"));
    draft.turned = in < out;
    return draft.turned ? out / in : in / out;
  }

  absl::StatusOr<scene::Microfacets> microfacets(const Parameters& from, double otherwise) {
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
    const bool two = from.has("alpha_u") || from.has("alpha_v");
    ASSIGN_OR_RETURN(Varying alpha,
                     varying_of(from, two ? "alpha_u" : "alpha", otherwise, surface_, to_));
    to.set_alpha(std::clamp(alpha.value, 0.0, 1.0));
    if (alpha.texture) {
      *to.mutable_alpha_texture() = *std::move(alpha.texture);
    }
    if (two) {
      ASSIGN_OR_RETURN(Varying across, varying_of(from, "alpha_v", otherwise, surface_, to_));
      to.set_alpha_v(std::clamp(across.value, 0.0, 1.0));
      if (across.texture) {
        *to.mutable_alpha_v_texture() = *std::move(across.texture);
      }
    }
    return to;
  }

  absl::Status dielectric(const Parameters& from, Draft& draft) {
    scene::Dielectric& to = *draft.material.mutable_dielectric();
    draft.transmits = true;
    ASSIGN_OR_RETURN(const double index, relative_index(from, "bk7", draft));
    to.set_index_of_refraction(std::clamp(index, 1.0, 5.0));
    if (from.object().type == "roughdielectric") {
      ASSIGN_OR_RETURN(*to.mutable_surface(), microfacets(from, 0.1));
    }
    return warn_of_tints(from);
  }

  absl::Status warn_of_tints(const Parameters& from) {
    for (const char* name : {"specular_reflectance", "specular_transmittance"}) {
      const Property* property = from.find(name);
      if (property == nullptr) {
        continue;
      }
      ASSIGN_OR_RETURN(const std::optional<Rgb> color,
                       constant_color(*property, ColorOf::kSurface));
      if (!color || !(*color == gray(1))) {
        to_.warn(property->place, absl::StrCat("\"", name, "\" of glass is left out"));
      }
    }
    return absl::OkStatus();
  }

  absl::Status thin_dielectric(const Parameters& from, Draft& draft) {
    scene::ThinDielectric& to = *draft.material.mutable_thin_dielectric();
    draft.transmits = true;
    ASSIGN_OR_RETURN(const double index, relative_index(from, "bk7", draft));
    draft.turned = false;  // it is the same on both sides
    to.set_index_of_refraction(std::clamp(index, 1.0, 5.0));
    to.set_free_passage(to_.passages_are_free);
    RETURN_IF_ERROR(
        color_only(from, "specular_reflectance", [&] { return to.mutable_specular(); }));
    return color_only(from, "specular_transmittance", [&] { return to.mutable_transmission(); });
  }

  absl::Status set_metal(const Parameters& from, scene::Conductor& to) {
    ASSIGN_OR_RETURN(const std::string name, from.text("material", from.has("eta") ? "" : "Cu"));
    if (name == "none") {
      return absl::OkStatus();
    }
    if (!name.empty()) {
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
    for (const bool real : {true, false}) {
      const Property* property = from.find(real ? "eta" : "k");
      if (property == nullptr) {
        return error_at(from.place(), "a conductor needs both \"eta\" and \"k\"");
      }
      ASSIGN_OR_RETURN(const std::optional<Rgb> color,
                       constant_color(*property, ColorOf::kSurface));
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

  absl::Status conductor(const Parameters& from, Draft& draft) {
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

  absl::Status plastic(const Parameters& from, Draft& draft) {
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
    RETURN_IF_ERROR(
        color_only(from, "specular_reflectance", [&] { return to.mutable_specular(); }));
    return color_or_texture(
        from, "diffuse_reflectance", [&] { return to.mutable_color(); },
        [&] { return to.mutable_texture(); });
  }

  absl::Status parameter(const Parameters& from, const std::string& name, double most,
                         const std::function<scene::Parameter*()>& field) {
    if (!from.has(name)) {
      return absl::OkStatus();
    }
    ASSIGN_OR_RETURN(Varying varying, varying_of(from, name, 0, surface_, to_));
    scene::Parameter& to = *field();
    if (varying.texture && most > 1) {
      // Textures of a number are at most 1.
      *to.mutable_texture()->mutable_product()->mutable_a() = *std::move(varying.texture);
      *to.mutable_texture()->mutable_product()->mutable_b() =
          constant_texture(gray(static_cast<float>(1 / most)));
      to.set_value(most);
    } else if (varying.texture) {
      *to.mutable_texture() = *std::move(varying.texture);
    } else {
      to.set_value(std::clamp(varying.value, 0.0, most));
    }
    return absl::OkStatus();
  }

  absl::Status principled(const Parameters& from, Draft& draft) {
    scene::Principled& to = *draft.material.mutable_principled();
    RETURN_IF_ERROR(color_or_texture(
        from, "base_color", [&] { return to.mutable_base_color(); },
        [&] { return to.mutable_base_color_texture(); }));
    const std::pair<const char*, std::function<scene::Parameter*()>> fields[] = {
        {"roughness", [&] { return to.mutable_roughness(); }},
        {"anisotropic", [&] { return to.mutable_anisotropic(); }},
        {"metallic", [&] { return to.mutable_metallic(); }},
        {"spec_trans", [&] { return to.mutable_spec_trans(); }},
        {"spec_tint", [&] { return to.mutable_spec_tint(); }},
        {"sheen", [&] { return to.mutable_sheen(); }},
        {"sheen_tint", [&] { return to.mutable_sheen_tint(); }},
        {"flatness", [&] { return to.mutable_flatness(); }},
        {"clearcoat", [&] { return to.mutable_clearcoat(); }},
        {"clearcoat_gloss", [&] { return to.mutable_clearcoat_gloss(); }}};
    for (const auto& [name, field] : fields) {
      RETURN_IF_ERROR(parameter(from, name, 1, field));
    }
    if (from.has("eta")) {
      ASSIGN_OR_RETURN(const double eta, from.number("eta", 1.5));
      to.set_index_of_refraction(std::clamp(eta, 1.0, 5.0));
    } else {
      ASSIGN_OR_RETURN(const double specular, from.number("specular", 0.5));
      to.set_specular(std::clamp(specular, 0.0, 1.0));
    }
    from.ignore({"main_specular_sampling_rate", "clearcoat_sampling_rate",
                 "diffuse_reflectance_sampling_rate", "diffuse_transmittance_sampling_rate",
                 "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate"});
    draft.transmits = to.has_spec_trans();
    return absl::OkStatus();
  }

  absl::Status thin_principled(const Parameters& from, Draft& draft) {
    scene::ThinPrincipled& to = *draft.material.mutable_thin_principled();
    draft.transmits = true;
    RETURN_IF_ERROR(color_or_texture(
        from, "base_color", [&] { return to.mutable_base_color(); },
        [&] { return to.mutable_base_color_texture(); }));
    const std::pair<const char*, std::function<scene::Parameter*()>> fields[] = {
        {"roughness", [&] { return to.mutable_roughness(); }},
        {"anisotropic", [&] { return to.mutable_anisotropic(); }},
        {"spec_trans", [&] { return to.mutable_spec_trans(); }},
        {"spec_tint", [&] { return to.mutable_spec_tint(); }},
        {"sheen", [&] { return to.mutable_sheen(); }},
        {"sheen_tint", [&] { return to.mutable_sheen_tint(); }},
        {"flatness", [&] { return to.mutable_flatness(); }}};
    for (const auto& [name, field] : fields) {
      RETURN_IF_ERROR(parameter(from, name, 1, field));
    }
    RETURN_IF_ERROR(parameter(from, "diff_trans", 2, [&] { return to.mutable_diff_trans(); }));
    ASSIGN_OR_RETURN(const double eta, from.number("eta", 1.5));
    to.set_index_of_refraction(std::clamp(eta, 1.0, 5.0));
    from.ignore({"spec_reflect_sampling_rate", "spec_trans_sampling_rate", "diffuse_sampling_rate",
                 "diffuse_reflectance_sampling_rate", "diffuse_transmittance_sampling_rate",
                 "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate"});
    return absl::OkStatus();
  }

  absl::Status diffuse_transmission(const Parameters& from, Draft& draft) {
    scene::DiffuseTransmission& to = *draft.material.mutable_diffuse_transmission();
    draft.transmits = true;
    set_color({}, to.mutable_reflectance());
    set_color(gray(0.5f), to.mutable_transmittance());
    return color_or_texture(
        from, "transmittance", [&] { return to.mutable_transmittance(); },
        [&] { return to.mutable_transmittance_texture(); });
  }

  /// A highlight of version 0.x as a coat of plastic with the given alpha.
  absl::Status highlight(const Parameters& from, double alpha, Draft& draft) {
    scene::Plastic& to = *draft.material.mutable_plastic();
    to_.warn(from.place(), absl::StrCat("bsdf \"", from.object().type,
                                        "\" is shown as rough plastic with alpha ", alpha));
    to.mutable_surface()->set_alpha(std::clamp(alpha, 0.0, 1.0));
    from.ignore({"specular_reflectance", "variant"});
    return color_or_texture(
        from, "diffuse_reflectance", [&] { return to.mutable_color(); },
        [&] { return to.mutable_texture(); });
  }

  absl::Status phong(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Varying exponent, varying_of(from, "exponent", 30, surface_, to_));
    // Beckmann's lobe of the same width at its peak (Walter et al. 2007, section 5.3).
    return highlight(from, std::sqrt(2 / (std::max(exponent.value, 0.0) + 2)), draft);
  }

  absl::Status ward(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Varying alpha,
                     varying_of(from, from.has("alpha") ? "alpha" : "alpha_u", 0.1, surface_, to_));
    from.ignore({"alpha_v"});
    return highlight(from, alpha.value, draft);
  }

  /// Returns the only bsdf inside a wrapper.
  absl::StatusOr<const Object*> inner(const Parameters& from) {
    const auto inside = from.objects("bsdf");
    if (inside.empty()) {
      return error_at(from.place(),
                      absl::StrCat("bsdf \"", from.object().type, "\" needs a bsdf inside"));
    }
    return object_in(*inside.front());
  }

  absl::Status two_sided(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Object* inside, inner(from));
    const auto both = from.objects("bsdf");
    if (both.size() > 1 && object_in(*both[1]) != inside) {
      to_.warn(both[1]->place, "the back of \"twosided\" is shown as its front");
    }
    draft.two_sided = true;
    return read(*inside, draft);
  }

  absl::Status mask(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Object* inside, inner(from));
    RETURN_IF_ERROR(read(*inside, draft));
    ASSIGN_OR_RETURN(Varying opacity, varying_of(from, "opacity", 0.5, surface_, to_));
    if (draft.material.has_opacity() || draft.material.has_opacity_texture()) {
      to_.warn(from.place(), "a mask within a mask is left out");
      return absl::OkStatus();
    }
    if (opacity.texture) {
      *draft.material.mutable_opacity_texture() = *std::move(opacity.texture);
    } else {
      draft.material.set_opacity(std::clamp(opacity.value, 0.0, 1.0));
    }
    return absl::OkStatus();
  }

  absl::Status normal_map(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Object* inside, inner(from));
    RETURN_IF_ERROR(read(*inside, draft));
    const Property* map = from.find("normalmap");
    if (map == nullptr && !from.objects("texture").empty()) {
      map = from.objects("texture").front();
    }
    if (map == nullptr) {
      return error_at(from.place(), "bsdf \"normalmap\" needs a texture");
    }
    ASSIGN_OR_RETURN(scene::Texture texture, texture_of(*map, ColorOf::kSurface, surface_, to_));
    if (draft.material.has_normal_texture() || draft.material.has_bump_texture()) {
      to_.warn(from.place(), "of several normal and bump maps the innermost is shown");
      return absl::OkStatus();
    }
    *draft.material.mutable_normal_texture() = std::move(texture);
    return absl::OkStatus();
  }

  absl::Status bump_map(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Object* inside, inner(from));
    RETURN_IF_ERROR(read(*inside, draft));
    ASSIGN_OR_RETURN(const double scale, from.number("scale", 1));
    const auto textures = from.objects("texture");
    if (textures.empty()) {
      return error_at(from.place(), "bsdf \"bumpmap\" needs a texture");
    }
    ASSIGN_OR_RETURN(scene::Texture texture,
                     texture_of(*textures.front(), ColorOf::kSurface, surface_, to_));
    if (draft.material.has_normal_texture() || draft.material.has_bump_texture()) {
      to_.warn(from.place(), "of several normal and bump maps the innermost is shown");
      return absl::OkStatus();
    }
    *draft.material.mutable_bump_texture() = std::move(texture);
    draft.material.set_bump_scale(scale);
    return absl::OkStatus();
  }

  absl::Status coating(const Parameters& from, Draft& draft) {
    ASSIGN_OR_RETURN(const Object* inside, inner(from));
    to_.warn(from.place(),
             absl::StrCat("the coat of bsdf \"", from.object().type, "\" is left out"));
    from.ignore({"int_ior", "ext_ior", "thickness", "sigma_a", "specular_reflectance", "alpha",
                 "distribution"});
    return read(*inside, draft);
  }

  const TexturedSurface& surface_;
  Conversion& to_;
};

/// Returns the bsdf inside wrappers that do not matter for whether it is "null" or a blend.
const Object* unwrapped(const Object* bsdf) {
  while (bsdf != nullptr && bsdf->type == "twosided") {
    const auto inside = Parameters(*bsdf).objects("bsdf");
    bsdf = inside.empty() ? nullptr : object_in(*inside.front());
  }
  return bsdf;
}

/// Adds the radiance of an area emitter.
absl::Status add_emission(const Object& emitter, const TexturedSurface& surface,
                          scene::Material& material, Conversion& to) {
  const Parameters from(emitter);
  const Property* radiance = from.find("radiance");
  from.ignore({"sampling_weight"});
  material.set_emission_one_sided(true);
  if (radiance == nullptr) {
    set_color(gray(1), material.mutable_emission());
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const std::optional<Rgb> color, constant_color(*radiance, ColorOf::kLight));
  if (color) {
    const auto least = [](float c) { return std::max(c, 0.0f); };
    set_color({least(color->r), least(color->g), least(color->b)}, material.mutable_emission());
  } else {
    ASSIGN_OR_RETURN(*material.mutable_emission_texture(),
                     texture_of(*radiance, ColorOf::kLight, surface, to));
  }
  to.warn_of_unused(from);
  return absl::OkStatus();
}

}  // namespace

bool needs_uv(const Object* bsdf, const Object* emitter) {
  if (emitter != nullptr && uses_uv(Value(emitter))) {
    return true;
  }
  if (bsdf == nullptr) {
    return false;
  }
  // The direction of grooves follows u.
  const bool grooves = Parameters(*bsdf).has("anisotropic") || Parameters(*bsdf).has("alpha_u");
  if (grooves || uses_uv(Value(bsdf))) {
    return true;
  }
  return std::any_of(bsdf->properties.begin(), bsdf->properties.end(), [](const Property& p) {
    const Object* inside = object_in(p);
    return inside != nullptr && inside->tag == "bsdf" && needs_uv(inside, nullptr);
  });
}

bool needs_handedness(const Object* bsdf) {
  return bsdf != nullptr &&
         (bsdf->type == "normalmap" ||
          std::any_of(bsdf->properties.begin(), bsdf->properties.end(), [](const Property& p) {
            const Object* inside = object_in(p);
            return inside != nullptr && inside->tag == "bsdf" && needs_handedness(inside);
          }));
}

bool is_null(const Object* bsdf) {
  const Object* inside = unwrapped(bsdf);
  return inside != nullptr && inside->type == "null";
}

std::string Materials::unique_name(const Object* bsdf) {
  const std::string base = bsdf == nullptr ? "default" : !bsdf->id.empty() ? bsdf->id : bsdf->type;
  std::string name = base;
  while (!names_.insert(name).second) {
    name = absl::StrCat(base, " ", ++counts_[base] + 1);
  }
  return name;
}

absl::StatusOr<SurfaceMaterial> Materials::add(scene::Material material, bool turned,
                                               const Object* bsdf, const Object* emitter,
                                               const TexturedSurface& surface) {
  if (emitter != nullptr) {
    RETURN_IF_ERROR(add_emission(*emitter, surface, material, to_));
  }
  material.set_name(unique_name(bsdf));
  *scene_.add_material() = std::move(material);
  return SurfaceMaterial{scene_.material(scene_.material_size() - 1).name(), turned};
}

absl::StatusOr<SurfaceMaterial> Materials::blend(const Object& bsdf, const Object* emitter,
                                                 const TexturedSurface& surface) {
  const Parameters from(bsdf);
  const auto parts = from.objects("bsdf");
  if (parts.size() != 2) {
    return error_at(bsdf.place, absl::StrCat("bsdf \"", bsdf.type, "\" must have two bsdfs, has ",
                                             parts.size()));
  }
  Varying weight{0.5};
  if (bsdf.type == "mixturebsdf") {  // version 0.x: "weights" of both
    ASSIGN_OR_RETURN(const std::string weights, from.text("weights", "0.5, 0.5"));
    to_.warn(bsdf.place, absl::StrCat("bsdf \"mixturebsdf\" with the weights ", weights,
                                      " is shown as an equal mixture"));
  } else {
    ASSIGN_OR_RETURN(weight, varying_of(from, "weight", 0.5, surface, to_));
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial a, material_of(object_in(*parts[0]), emitter, surface));
  ASSIGN_OR_RETURN(const SurfaceMaterial b, material_of(object_in(*parts[1]), emitter, surface));
  if (a.name.empty() || b.name.empty()) {
    return error_at(bsdf.place, "a blend with \"null\" is not read: write a mask");
  }
  scene::Material material;
  material.set_name(unique_name(&bsdf));
  material.mutable_mix()->set_a(a.name);
  material.mutable_mix()->set_b(b.name);
  *material.mutable_mix()->mutable_amount() =
      weight.texture
          ? *std::move(weight.texture)
          : constant_texture(gray(static_cast<float>(std::clamp(weight.value, 0.0, 1.0))));
  to_.warn_of_unused(from);
  *scene_.add_material() = material;
  return SurfaceMaterial{material.name(), a.turned || b.turned};
}

absl::StatusOr<SurfaceMaterial> Materials::make(const Object* bsdf, const Object* emitter,
                                                const TexturedSurface& surface) {
  if (is_null(bsdf) && emitter == nullptr) {
    return SurfaceMaterial{};
  }
  const Object* inside = unwrapped(bsdf);
  if (inside != nullptr && (inside->type == "blendbsdf" || inside->type == "mixturebsdf")) {
    if (inside != bsdf) {
      to_.warn(bsdf->place,
               "a \"twosided\" blend shows each part as it is: write \"twosided\" "
               "inside the blend");
    }
    return blend(*inside, emitter, surface);
  }
  Draft draft;
  if (is_null(bsdf)) {  // emits, but does not scatter
    set_color({}, draft.material.mutable_diffuse()->mutable_color());
  } else if (bsdf == nullptr) {
    set_color(gray(0.5f), draft.material.mutable_diffuse()->mutable_color());
  } else {
    RETURN_IF_ERROR(BsdfReader(surface, to_).read(*bsdf, draft));
  }
  if (!draft.two_sided && !draft.transmits) {
    draft.material.set_one_sided(true);
  }
  return add(std::move(draft.material), draft.turned, bsdf, emitter, surface);
}

absl::StatusOr<SurfaceMaterial> Materials::sides_of(const Object* bsdf) const {
  SurfaceMaterial sides;
  while (bsdf != nullptr && bsdf->type != "dielectric" && bsdf->type != "roughdielectric") {
    const auto inside = Parameters(*bsdf).objects("bsdf");
    bsdf = inside.empty() ? nullptr : object_in(*inside.front());
  }
  if (bsdf != nullptr) {
    const Parameters from(*bsdf);
    ASSIGN_OR_RETURN(const double in, index_of_refraction(from, "int_ior", "bk7"));
    ASSIGN_OR_RETURN(const double out, index_of_refraction(from, "ext_ior", "air"));
    sides.turned = in < out;
  }
  return sides;
}

absl::StatusOr<SurfaceMaterial> Materials::material_of(const Object* bsdf, const Object* emitter,
                                                       const TexturedSurface& surface) {
  const Key key{bsdf, emitter, surface.frame, surface.attributes};
  const auto known = known_.find(key);
  if (known != known_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(const SurfaceMaterial made, make(bsdf, emitter, surface));
  known_.emplace(key, made);
  return made;
}

}  // namespace bandsaw::mitsuba
