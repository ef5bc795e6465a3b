#include "renderlib/import/scene_file/read_materials.h"

#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_gltf.h"
#include "renderlib/import/scene_file/read_textures.h"
#include "renderlib/import/scene_file/suggest.h"

namespace bandsaw {
namespace {

// A material's colour: `texture`, or its short form `short_name`, or the default.
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

// The texture of a number, where it is given.
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
    case scene::Material::KIND_NOT_SET:
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
