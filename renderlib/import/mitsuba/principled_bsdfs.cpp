// Converts Mitsuba's bsdfs "principled" and "principledthin", with functions of BsdfReader.

#include <algorithm>
#include <type_traits>
#include <utility>

#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/bsdf_reader.h"

namespace bandsaw::mitsuba {

/// Sets field() to the parameter `name`: a texture of numbers, or a number clamped to [0, most].
absl::Status BsdfReader::parameter(const Parameters& from, const std::string& name, double most,
                                   const std::function<scene::Parameter*()>& field) {
  if (!from.has(name)) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(Varying varying, varying_of(from, name, 0, surface_, to_));
  scene::Parameter& to = *field();
  if (varying.texture && most > 1) {
    // The texels of a texture of numbers are at most 1. So the texture is divided by `most`, and
    // the field `value`, which multiplies the texture, is set to `most`.
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

/// Reads the base colour and the parameters that both kinds have, and `metallic` if `to` has it.
template <class Message>
absl::Status BsdfReader::common_parameters(const Parameters& from, Message& to) {
  RETURN_IF_ERROR(color_or_texture(
      from, "base_color", [&] { return to.mutable_base_color(); },
      [&] { return to.mutable_base_color_texture(); }));
  RETURN_IF_ERROR(parameter(from, "roughness", 1, [&] { return to.mutable_roughness(); }));
  RETURN_IF_ERROR(parameter(from, "anisotropic", 1, [&] { return to.mutable_anisotropic(); }));
  if constexpr (std::is_same_v<Message, scene::Principled>) {
    RETURN_IF_ERROR(parameter(from, "metallic", 1, [&] { return to.mutable_metallic(); }));
  }
  RETURN_IF_ERROR(parameter(from, "spec_trans", 1, [&] { return to.mutable_spec_trans(); }));
  RETURN_IF_ERROR(parameter(from, "spec_tint", 1, [&] { return to.mutable_spec_tint(); }));
  RETURN_IF_ERROR(parameter(from, "sheen", 1, [&] { return to.mutable_sheen(); }));
  RETURN_IF_ERROR(parameter(from, "sheen_tint", 1, [&] { return to.mutable_sheen_tint(); }));
  return parameter(from, "flatness", 1, [&] { return to.mutable_flatness(); });
}

absl::Status BsdfReader::principled(const Parameters& from, Draft& draft) {
  scene::Principled& to = *draft.material.mutable_principled();
  RETURN_IF_ERROR(common_parameters(from, to));
  RETURN_IF_ERROR(parameter(from, "clearcoat", 1, [&] { return to.mutable_clearcoat(); }));
  RETURN_IF_ERROR(
      parameter(from, "clearcoat_gloss", 1, [&] { return to.mutable_clearcoat_gloss(); }));
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

absl::Status BsdfReader::thin_principled(const Parameters& from, Draft& draft) {
  scene::ThinPrincipled& to = *draft.material.mutable_thin_principled();
  draft.transmits = true;
  RETURN_IF_ERROR(common_parameters(from, to));
  RETURN_IF_ERROR(parameter(from, "diff_trans", 2, [&] { return to.mutable_diff_trans(); }));
  ASSIGN_OR_RETURN(const double eta, from.number("eta", 1.5));
  to.set_index_of_refraction(std::clamp(eta, 1.0, 5.0));
  from.ignore({"spec_reflect_sampling_rate", "spec_trans_sampling_rate", "diffuse_sampling_rate",
               "diffuse_reflectance_sampling_rate", "diffuse_transmittance_sampling_rate",
               "specular_reflectance_sampling_rate", "specular_transmittance_sampling_rate"});
  return absl::OkStatus();
}

}  // namespace bandsaw::mitsuba
