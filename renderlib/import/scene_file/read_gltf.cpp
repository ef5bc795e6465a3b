// Reads the material `gltf` of a scene file, glTF's metallic-roughness material. Each function
// reads the fields of one part: base colour, metallic and roughness, layers, normals, emission,
// alpha.

#include "renderlib/import/scene_file/read_gltf.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/material_fields.h"

namespace bandsaw {
namespace {

absl::Status read_base(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                       MetallicRoughness& to) {
  ASSIGN_OR_RETURN(to.base_color.texture,
                   texture_or_white(in, "base_color_texture", from.has_base_color_texture(),
                                    from.base_color_texture(), kMaxReflectance, draft));
  if (from.has_base_color()) {
    ASSIGN_OR_RETURN(to.base_color.factor,
                     read_color(in.child("base_color"), from.base_color(), kMaxReflectance));
  }
  return absl::OkStatus();
}

absl::Status read_emission(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                           Emission& to) {
  ASSIGN_OR_RETURN(to.radiance.texture,
                   texture_or_white(in, "emissive_texture", from.has_emissive_texture(),
                                    from.emissive_texture(), kMaxRadiance, draft));
  to.radiance.factor = gray(from.has_emissive_texture() ? 1 : 0);
  if (from.has_emissive()) {
    ASSIGN_OR_RETURN(to.radiance.factor,
                     read_color(in.child("emissive"), from.emissive(), kMaxRadiance));
  }
  to.one_sided = !from.double_sided();
  return absl::OkStatus();
}

// Reads the factors and the textures of metallic and roughness. The two may share one texture.
absl::Status read_metallic_roughness(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                                     MetallicRoughness& to) {
  const bool both = from.has_metallic_roughness_texture();
  if (both && (from.has_metallic_texture() || from.has_roughness_texture())) {
    return in.error("metallic_roughness_texture",
                    "write it, or metallic_texture and roughness_texture, not both");
  }
  const bool metallic = both || from.has_metallic_texture();
  const bool rough = both || from.has_roughness_texture();
  if (both) {
    ASSIGN_OR_RETURN(to.metallic.texture,
                     read_texture(in.child("metallic_roughness_texture"),
                                  from.metallic_roughness_texture(), kMaxReflectance, draft));
    to.roughness.texture = to.metallic.texture;
  } else {
    ASSIGN_OR_RETURN(to.metallic.texture,
                     texture_or_white(in, "metallic_texture", metallic, from.metallic_texture(),
                                      kMaxReflectance, draft));
    ASSIGN_OR_RETURN(to.roughness.texture,
                     texture_or_white(in, "roughness_texture", rough, from.roughness_texture(),
                                      kMaxReflectance, draft));
  }
  to.metallic.factor = from.has_metallic() ? from.metallic() : metallic ? 1 : 0;
  to.roughness.factor = from.has_roughness() ? from.roughness() : rough ? 1 : 0.5;
  RETURN_IF_ERROR(check_range(in, "metallic", to.metallic.factor, 0, 1));
  return check_range(in, "roughness", to.roughness.factor, 0, 1);
}

// A number in [0, 1] that may have a texture. An absent number is 1 if there is a texture and 0
// otherwise.
struct OptionalNumber {
  const char* name;
  bool given;
  double value;
  bool textured;
  const scene::Texture& texture;
};

absl::StatusOr<Channel> read_channel(const Field& in, const OptionalNumber& from,
                                     SceneDraft& draft) {
  Channel to;
  ASSIGN_OR_RETURN(to.texture,
                   texture_or_white(in, absl::StrCat(from.name, "_texture"), from.textured,
                                    from.texture, kMaxReflectance, draft));
  to.factor = from.given ? from.value : from.textured ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, from.name, to.factor, 0, 1));
  return to;
}

absl::Status read_layers(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                         MetallicRoughness& to) {
  ASSIGN_OR_RETURN(to.coat, read_channel(in,
                                         {"clearcoat", from.has_clearcoat(), from.clearcoat(),
                                          from.has_clearcoat_texture(), from.clearcoat_texture()},
                                         draft));
  ASSIGN_OR_RETURN(to.coat_roughness,
                   read_channel(in,
                                {"clearcoat_roughness", from.has_clearcoat_roughness(),
                                 from.clearcoat_roughness(), from.has_clearcoat_roughness_texture(),
                                 from.clearcoat_roughness_texture()},
                                draft));
  ASSIGN_OR_RETURN(to.transmission,
                   read_channel(in,
                                {"transmission", from.has_transmission(), from.transmission(),
                                 from.has_transmission_texture(), from.transmission_texture()},
                                draft));
  if (from.has_index_of_refraction()) {
    to.index_of_refraction = from.index_of_refraction();
  }
  if (from.has_index_of_refraction_texture()) {
    ASSIGN_OR_RETURN(to.index_map,
                     read_texture(in.child("index_of_refraction_texture"),
                                  from.index_of_refraction_texture(), kMaxReflectance, draft));
  }
  return check_range(in, "index_of_refraction", to.index_of_refraction, 1, 5);
}

absl::Status read_normals(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                          Relief& relief, MetallicRoughness& to) {
  if (from.has_normal_texture()) {
    ASSIGN_OR_RETURN(relief.normal, read_texture(in.child("normal_texture"), from.normal_texture(),
                                                 kMaxReflectance, draft));
  }
  if (from.has_clearcoat_normal_texture()) {
    ASSIGN_OR_RETURN(to.coat_normal,
                     read_texture(in.child("clearcoat_normal_texture"),
                                  from.clearcoat_normal_texture(), kMaxReflectance, draft));
  }
  relief.normal_scale = from.has_normal_scale() ? from.normal_scale() : 1;
  to.coat_normal_scale = from.has_clearcoat_normal_scale() ? from.clearcoat_normal_scale() : 1;
  RETURN_IF_ERROR(check_range(in, "clearcoat_normal_scale", to.coat_normal_scale, -1e30, 1e30));
  return check_range(in, "normal_scale", relief.normal_scale, -1e30, 1e30);
}

absl::Status read_alpha(const Field& in, const scene::Gltf& from, SceneDraft& draft, Alpha& to) {
  if (!scene::Gltf::AlphaMode_IsValid(from.alpha_mode())) {
    return in.error("alpha_mode", absl::StrCat("has the unknown value ", from.alpha_mode()));
  }
  // AlphaMode and the enum of the scene file have their values in the same order.
  to.mode = static_cast<AlphaMode>(from.alpha_mode());
  ASSIGN_OR_RETURN(to.value.texture,
                   texture_or_white(in, "alpha_texture", from.has_alpha_texture(),
                                    from.alpha_texture(), kMaxReflectance, draft));
  to.value.factor = from.has_alpha() ? from.alpha() : 1;
  to.cutoff = from.has_alpha_cutoff() ? from.alpha_cutoff() : 0.5;
  RETURN_IF_ERROR(check_range(in, "alpha", to.value.factor, 0, 1));
  return check_range(in, "alpha_cutoff", to.cutoff, 0, 1e30);
}

}  // namespace

absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft) {
  MetallicRoughness layers;
  Material to;
  RETURN_IF_ERROR(read_base(in, from, draft, layers));
  RETURN_IF_ERROR(read_emission(in, from, draft, to.emission));
  RETURN_IF_ERROR(read_metallic_roughness(in, from, draft, layers));
  RETURN_IF_ERROR(read_layers(in, from, draft, layers));
  RETURN_IF_ERROR(read_alpha(in, from, draft, to.alpha));
  RETURN_IF_ERROR(read_normals(in, from, draft, to.relief, layers));
  to.kind = layers;
  return to;
}

}  // namespace bandsaw
