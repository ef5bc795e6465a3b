#include "renderlib/import/read_gltf.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/numbers.h"
#include "renderlib/import/read_textures.h"

namespace bandsaw {
namespace {

absl::StatusOr<TextureId> texture_or_white(const Field& in, const std::string& name, bool given,
                                           const scene::Texture& from, float most,
                                           SceneDraft& draft) {
  return given ? read_texture(in.child(name), from, most, draft)
               : draft.textures.constant({1, 1, 1});
}

absl::Status read_colors(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                         Principled& to) {
  ASSIGN_OR_RETURN(to.base_color.texture,
                   texture_or_white(in, "base_color_texture", from.has_base_color_texture(),
                                    from.base_color_texture(), kMostReflectance, draft));
  if (from.has_base_color()) {
    ASSIGN_OR_RETURN(to.base_color.factor,
                     read_color(in.child("base_color"), from.base_color(), kMostReflectance));
  }
  ASSIGN_OR_RETURN(to.emissive.texture,
                   texture_or_white(in, "emissive_texture", from.has_emissive_texture(),
                                    from.emissive_texture(), kMostRadiance, draft));
  to.emissive.factor = gray(from.has_emissive_texture() ? 1 : 0);
  if (from.has_emissive()) {
    ASSIGN_OR_RETURN(to.emissive.factor,
                     read_color(in.child("emissive"), from.emissive(), kMostRadiance));
  }
  return absl::OkStatus();
}

absl::Status read_numbers(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                          Principled& to) {
  const bool textured = from.has_metallic_roughness_texture();
  ASSIGN_OR_RETURN(const TextureId rough,
                   texture_or_white(in, "metallic_roughness_texture", textured,
                                    from.metallic_roughness_texture(), kMostReflectance, draft));
  const TextureId white = draft.textures.constant({1, 1, 1});
  to.metallic = {rough, from.has_metallic() ? from.metallic() : textured ? 1 : 0};
  to.roughness = {rough, from.has_roughness() ? from.roughness() : textured ? 1 : 0.5};
  to.coat = {white, from.clearcoat()};
  to.coat_roughness = {white, from.clearcoat_roughness()};
  to.transmission = {white, from.transmission()};
  RETURN_IF_ERROR(check_range(in, "metallic", to.metallic.factor, 0, 1));
  RETURN_IF_ERROR(check_range(in, "roughness", to.roughness.factor, 0, 1));
  RETURN_IF_ERROR(check_range(in, "clearcoat", to.coat.factor, 0, 1));
  RETURN_IF_ERROR(check_range(in, "clearcoat_roughness", to.coat_roughness.factor, 0, 1));
  RETURN_IF_ERROR(check_range(in, "transmission", to.transmission.factor, 0, 1));
  if (from.has_index_of_refraction()) {
    to.index_of_refraction = from.index_of_refraction();
  }
  return check_range(in, "index_of_refraction", to.index_of_refraction, 1, 5);
}

absl::Status read_alpha(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                        Principled& to) {
  if (!scene::Gltf::AlphaMode_IsValid(from.alpha_mode())) {
    return in.error("alpha_mode", absl::StrCat("is no mode: ", from.alpha_mode()));
  }
  // The enums are declared in the same order.
  to.alpha_mode = static_cast<AlphaMode>(from.alpha_mode());
  ASSIGN_OR_RETURN(to.alpha.texture,
                   texture_or_white(in, "alpha_texture", from.has_alpha_texture(),
                                    from.alpha_texture(), kMostReflectance, draft));
  to.alpha.factor = from.has_alpha() ? from.alpha() : 1;
  to.alpha_cutoff = from.has_alpha_cutoff() ? from.alpha_cutoff() : 0.5;
  RETURN_IF_ERROR(check_range(in, "alpha", to.alpha.factor, 0, 1));
  return check_range(in, "alpha_cutoff", to.alpha_cutoff, 0, 1e30);
}

}  // namespace

absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft) {
  Principled to;
  RETURN_IF_ERROR(read_colors(in, from, draft, to));
  RETURN_IF_ERROR(read_numbers(in, from, draft, to));
  RETURN_IF_ERROR(read_alpha(in, from, draft, to));
  if (from.has_normal_texture()) {
    ASSIGN_OR_RETURN(to.normal, read_texture(in.child("normal_texture"), from.normal_texture(),
                                             kMostReflectance, draft));
  }
  to.normal_scale = from.has_normal_scale() ? from.normal_scale() : 1;
  RETURN_IF_ERROR(check_range(in, "normal_scale", to.normal_scale, -1e30, 1e30));
  to.double_sided = from.double_sided();
  return Material(to);
}

}  // namespace bandsaw
