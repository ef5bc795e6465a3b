#include "renderlib/import/scene_file/read_materials.h"

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "proto/scene.pb.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_textures.h"
#include "renderlib/import/scene_file/suggest.h"

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
                                    from.base_color_texture(), kMaxReflectance, draft));
  if (from.has_base_color()) {
    ASSIGN_OR_RETURN(to.base_color.factor,
                     read_color(in.child("base_color"), from.base_color(), kMaxReflectance));
  }
  ASSIGN_OR_RETURN(to.emissive.texture,
                   texture_or_white(in, "emissive_texture", from.has_emissive_texture(),
                                    from.emissive_texture(), kMaxRadiance, draft));
  to.emissive.factor = gray(from.has_emissive_texture() ? 1 : 0);
  if (from.has_emissive()) {
    ASSIGN_OR_RETURN(to.emissive.factor,
                     read_color(in.child("emissive"), from.emissive(), kMaxRadiance));
  }
  return absl::OkStatus();
}

// Sets the textures of metallic and roughness: one for both, or one for each.
absl::Status read_metallic_roughness(const Field& in, const scene::Gltf& from, SceneDraft& draft,
                                     Principled& to) {
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

// A number that is 0 unless it or its texture is present.
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
                         Principled& to) {
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
                          Principled& to) {
  if (from.has_normal_texture()) {
    ASSIGN_OR_RETURN(to.normal, read_texture(in.child("normal_texture"), from.normal_texture(),
                                             kMaxReflectance, draft));
  }
  if (from.has_clearcoat_normal_texture()) {
    ASSIGN_OR_RETURN(to.coat_normal,
                     read_texture(in.child("clearcoat_normal_texture"),
                                  from.clearcoat_normal_texture(), kMaxReflectance, draft));
  }
  to.normal_scale = from.has_normal_scale() ? from.normal_scale() : 1;
  to.coat_normal_scale = from.has_clearcoat_normal_scale() ? from.clearcoat_normal_scale() : 1;
  RETURN_IF_ERROR(check_range(in, "clearcoat_normal_scale", to.coat_normal_scale, -1e30, 1e30));
  return check_range(in, "normal_scale", to.normal_scale, -1e30, 1e30);
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
                                    from.alpha_texture(), kMaxReflectance, draft));
  to.alpha.factor = from.has_alpha() ? from.alpha() : 1;
  to.alpha_cutoff = from.has_alpha_cutoff() ? from.alpha_cutoff() : 0.5;
  RETURN_IF_ERROR(check_range(in, "alpha", to.alpha.factor, 0, 1));
  return check_range(in, "alpha_cutoff", to.alpha_cutoff, 0, 1e30);
}

/// Reads the material of kind `gltf` of `in`.
absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft) {
  Principled to;
  RETURN_IF_ERROR(read_colors(in, from, draft, to));
  RETURN_IF_ERROR(read_metallic_roughness(in, from, draft, to));
  RETURN_IF_ERROR(read_layers(in, from, draft, to));
  RETURN_IF_ERROR(read_alpha(in, from, draft, to));
  RETURN_IF_ERROR(read_normals(in, from, draft, to));
  to.double_sided = from.double_sided();
  return Material(to);
}

// Reads a material's colour: `texture`, or its short form `short_name`, or the default.
template <class From>
absl::StatusOr<TextureId> read_reflectance(const Field& in, const From& from, float otherwise,
                                           SceneDraft& draft) {
  if (from.has_texture() && from.has_color()) {
    return in.error("color", "write texture or color, not both");
  }
  if (from.has_texture()) {
    return read_texture(in.child("texture"), from.texture(), kMaxReflectance, draft);
  }
  if (from.has_color()) {
    ASSIGN_OR_RETURN(const Rgb color, read_color(in.child("color"), from.color(), kMaxReflectance));
    return draft.textures.constant(color);
  }
  return draft.textures.constant(gray(otherwise));
}

// Reads the texture of a number, if it is present.
absl::StatusOr<std::optional<TextureId>> read_map(const Field& in, const std::string& name,
                                                  bool given, const scene::Texture& from,
                                                  SceneDraft& draft) {
  if (!given) {
    return std::optional<TextureId>();
  }
  ASSIGN_OR_RETURN(const TextureId id, read_texture(in.child(name), from, kMaxReflectance, draft));
  return std::optional(id);
}

absl::StatusOr<Material> read_metal(const Field& in, const scene::Metal& from, SceneDraft& draft) {
  Metal metal;
  ASSIGN_OR_RETURN(metal.reflectance, read_reflectance(in, from, 1, draft));
  ASSIGN_OR_RETURN(metal.fuzz_map, read_map(in, "fuzz_texture", from.has_fuzz_texture(),
                                            from.fuzz_texture(), draft));
  metal.fuzz = from.has_fuzz() ? from.fuzz() : metal.fuzz_map ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, "fuzz", metal.fuzz, 0, 1));
  return metal;
}

absl::StatusOr<Material> read_dielectric(const Field& in, const scene::Dielectric& from,
                                         SceneDraft& draft) {
  Dielectric glass;
  if (from.has_index_of_refraction()) {
    glass.index_of_refraction = from.index_of_refraction();
  }
  RETURN_IF_ERROR(check_range(in, "index_of_refraction", glass.index_of_refraction, 1, 5));
  ASSIGN_OR_RETURN(glass.roughness_map,
                   read_map(in, "roughness_texture", from.has_roughness_texture(),
                            from.roughness_texture(), draft));
  glass.roughness = from.has_roughness() ? from.roughness() : glass.roughness_map ? 1 : 0;
  RETURN_IF_ERROR(check_range(in, "roughness", glass.roughness, 0, 1));
  glass.priority = from.priority();
  ASSIGN_OR_RETURN(glass.index_map, read_map(in, "index_of_refraction_texture",
                                             from.has_index_of_refraction_texture(),
                                             from.index_of_refraction_texture(), draft));
  if (glass.index_map && glass.priority > 0) {
    return in.error("index_of_refraction_texture",
                    "a glass with a priority has one index of refraction; leave one of them out");
  }
  return glass;
}

absl::StatusOr<Material> read_emissive(const Field& in, const scene::Emissive& from,
                                       SceneDraft& draft) {
  if (from.has_texture() && from.has_radiance()) {
    return in.error("texture", "write radiance or texture, not both");
  }
  if (from.has_texture()) {
    ASSIGN_OR_RETURN(const TextureId id,
                     read_texture(in.child("texture"), from.texture(), kMaxRadiance, draft));
    return Emissive{id, from.one_sided()};
  }
  if (!from.has_radiance()) {
    return in.error("radiance", "is required, for example radiance { rgb: [15, 15, 15] }");
  }
  ASSIGN_OR_RETURN(const Rgb radiance,
                   read_color(in.child("radiance"), from.radiance(), kMaxRadiance));
  return Emissive{draft.textures.constant(radiance), from.one_sided()};
}

absl::StatusOr<Material> read_material(const Field& in, const scene::Material& from,
                                       SceneDraft& draft) {
  switch (from.kind_case()) {
    case scene::Material::kDiffuse: {
      ASSIGN_OR_RETURN(const TextureId id,
                       read_reflectance(in.child("diffuse"), from.diffuse(), 0.5f, draft));
      return Diffuse{id};
    }
    case scene::Material::kMetal:
      return read_metal(in.child("metal"), from.metal(), draft);
    case scene::Material::kDielectric:
      return read_dielectric(in.child("dielectric"), from.dielectric(), draft);
    case scene::Material::kGltf:
      return read_gltf(in.child("gltf"), from.gltf(), draft);
    case scene::Material::kEmissive:
      return read_emissive(in.child("emissive"), from.emissive(), draft);
    default:
      break;
  }
  return in.error("is of no kind: write diffuse, metal, dielectric, emissive or gltf");
}

}  // namespace

absl::Status read_materials(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  for (int i = 0; i < from.material_size(); ++i) {
    const Field in = root.child("material", i);
    const std::string& name = from.material(i).name();
    if (name.empty()) {
      return in.error("name", "is required, so that a shape can say what it is made of");
    }
    ASSIGN_OR_RETURN(const Material material, read_material(in, from.material(i), draft));
    if (!draft.materials.emplace(name, draft.add_material(material)).second) {
      return in.error("name", absl::StrCat("\"", name, "\" is the name of another material"));
    }
  }
  return absl::OkStatus();
}

absl::StatusOr<MaterialId> find_material(const Field& in, const std::string& name,
                                         const SceneDraft& draft) {
  if (name.empty()) {
    return in.error("material", "is required: the name of a material");
  }
  const auto found = draft.materials.find(name);
  if (found != draft.materials.end()) {
    return found->second;
  }
  std::vector<std::string> known;
  for (const auto& [other, id] : draft.materials) {
    known.push_back(other);
  }
  const std::string hint = did_you_mean(name, known);
  return in.error("material", absl::StrCat("no material is called \"", name, "\"",
                                           known.empty() ? "; the scene has none" : hint));
}

}  // namespace bandsaw
