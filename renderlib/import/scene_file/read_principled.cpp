// Reads both principled materials of a scene file: `principled` and `thin_principled`. Templates
// read the parameters that both materials have.

#include "renderlib/import/scene_file/read_principled.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/material_fields.h"

namespace bandsaw {
namespace {

/// Reads the number `name`. The file gives a constant in [0, most], a texture, or both. The
/// constant is 1 if there is only a texture. The result holds the constant divided by `most`. If
/// the number is not `given`, returns `otherwise` without dividing it.
absl::StatusOr<Number> read_number(const Field& in, const char* name, bool given,
                                   const scene::Parameter& from, double otherwise,
                                   SceneDraft& draft, double most = 1) {
  if (!given) {
    return Number{otherwise};
  }
  const Field field = in.child(name);
  Number to;
  ASSIGN_OR_RETURN(to.map, read_map(field, "texture", from.has_texture(), from.texture(), draft));
  if (!from.has_value() && !from.has_texture()) {
    return field.error("value", "is required if there is no texture");
  }
  to.value = from.has_value() ? from.value() : 1;
  RETURN_IF_ERROR(check_range(field, "value", to.value, 0, most));
  to.value /= most;
  return to;
}

template <class From>
absl::StatusOr<TextureId> read_base_color(const Field& in, const From& from, SceneDraft& draft) {
  return read_reflectance(
      in,
      {"base_color_texture", from.has_base_color_texture(), from.base_color_texture(), "base_color",
       from.has_base_color(), from.base_color(), 0.5f},
      draft);
}

/// Reads the numbers that both kinds have, and `metallic` if the kind has it.
template <class From, class To>
absl::Status read_common_numbers(const Field& in, const From& from, SceneDraft& draft, To& to) {
  ASSIGN_OR_RETURN(to.roughness, read_number(in, "roughness", from.has_roughness(),
                                             from.roughness(), 0.5, draft));
  ASSIGN_OR_RETURN(to.anisotropic, read_number(in, "anisotropic", from.has_anisotropic(),
                                               from.anisotropic(), 0, draft));
  if constexpr (std::is_same_v<To, Principled>) {
    ASSIGN_OR_RETURN(to.metallic,
                     read_number(in, "metallic", from.has_metallic(), from.metallic(), 0, draft));
  }
  ASSIGN_OR_RETURN(to.spec_trans, read_number(in, "spec_trans", from.has_spec_trans(),
                                              from.spec_trans(), 0, draft));
  ASSIGN_OR_RETURN(to.spec_tint,
                   read_number(in, "spec_tint", from.has_spec_tint(), from.spec_tint(), 0, draft));
  ASSIGN_OR_RETURN(to.sheen, read_number(in, "sheen", from.has_sheen(), from.sheen(), 0, draft));
  ASSIGN_OR_RETURN(to.sheen_tint, read_number(in, "sheen_tint", from.has_sheen_tint(),
                                              from.sheen_tint(), 0, draft));
  ASSIGN_OR_RETURN(to.flatness,
                   read_number(in, "flatness", from.has_flatness(), from.flatness(), 0, draft));
  return absl::OkStatus();
}

/// Returns the index of refraction of a principled material, as given or computed from
/// `specular`.
absl::StatusOr<double> read_index(const Field& in, const scene::Principled& from) {
  if (from.has_specular() && from.has_index_of_refraction()) {
    return in.error("specular", "write index_of_refraction or specular, not both");
  }
  if (!from.has_specular()) {
    return from.has_index_of_refraction() ? from.index_of_refraction() : 1.5;
  }
  RETURN_IF_ERROR(check_range(in, "specular", from.specular(), 0, 1));
  // The reflectance at normal incidence is 0.08 times `specular`. With transmission, `specular` has
  // a lower bound above 0, as in Mitsuba 3.
  const double least = from.has_spec_trans() ? 1e-3 : 0;
  return 2 / (1 - std::sqrt(0.08 * std::max(least, from.specular()))) - 1;
}

}  // namespace

absl::StatusOr<Material> read_principled(const Field& in, const scene::Principled& from,
                                         SceneDraft& draft) {
  Principled to;
  ASSIGN_OR_RETURN(to.base_color, read_base_color(in, from, draft));
  ASSIGN_OR_RETURN(to.index_of_refraction, read_index(in, from));
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", to.index_of_refraction, 1, 5));
  RETURN_IF_ERROR(read_common_numbers(in, from, draft, to));
  ASSIGN_OR_RETURN(to.clearcoat,
                   read_number(in, "clearcoat", from.has_clearcoat(), from.clearcoat(), 0, draft));
  ASSIGN_OR_RETURN(to.clearcoat_gloss,
                   read_number(in, "clearcoat_gloss", from.has_clearcoat_gloss(),
                               from.clearcoat_gloss(), 0, draft));
  return to;
}

absl::StatusOr<Material> read_thin_principled(const Field& in, const scene::ThinPrincipled& from,
                                              SceneDraft& draft) {
  ThinPrincipled to;
  ASSIGN_OR_RETURN(to.base_color, read_base_color(in, from, draft));
  if (from.has_index_of_refraction()) {
    to.index_of_refraction = from.index_of_refraction();
  }
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", to.index_of_refraction, 1, 5));
  RETURN_IF_ERROR(read_common_numbers(in, from, draft, to));
  ASSIGN_OR_RETURN(to.diff_trans, read_number(in, "diff_trans", from.has_diff_trans(),
                                              from.diff_trans(), 0, draft, /*most=*/2));
  return to;
}

}  // namespace bandsaw
