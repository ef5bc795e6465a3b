#include "renderlib/import/read_materials.h"

#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/numbers.h"
#include "renderlib/import/read_gltf.h"
#include "renderlib/import/read_textures.h"
#include "renderlib/import/suggest.h"

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
    return read_texture(in.child("texture"), from.texture(), kMostReflectance, draft);
  }
  if (from.has_color()) {
    ASSIGN_OR_RETURN(const Rgb color,
                     read_color(in.child("color"), from.color(), kMostReflectance));
    return draft.textures.constant(color);
  }
  return draft.textures.constant(gray(otherwise));
}

absl::StatusOr<Material> read_emissive(const Field& in, const scene::Emissive& from,
                                       SceneDraft& draft) {
  if (from.has_texture() && from.has_radiance()) {
    return in.error("texture", "write radiance or texture, not both");
  }
  if (from.has_texture()) {
    ASSIGN_OR_RETURN(const TextureId id,
                     read_texture(in.child("texture"), from.texture(), kMostRadiance, draft));
    return Emissive{id, from.one_sided()};
  }
  if (!from.has_radiance()) {
    return in.error("radiance", "is required, for example radiance { rgb: [15, 15, 15] }");
  }
  ASSIGN_OR_RETURN(const Rgb radiance,
                   read_color(in.child("radiance"), from.radiance(), kMostRadiance));
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
    case scene::Material::kMetal: {
      const Field metal = in.child("metal");
      RETURN_IF_ERROR(check_range(metal, "fuzz", from.metal().fuzz(), 0, 1));
      ASSIGN_OR_RETURN(const TextureId id, read_reflectance(metal, from.metal(), 1, draft));
      return Metal{id, from.metal().fuzz()};
    }
    case scene::Material::kDielectric: {
      Dielectric glass;
      if (from.dielectric().has_index_of_refraction()) {
        glass.index_of_refraction = from.dielectric().index_of_refraction();
      }
      RETURN_IF_ERROR(check_range(in.child("dielectric"), "index_of_refraction",
                                  glass.index_of_refraction, 1, 5));
      glass.roughness = from.dielectric().roughness();
      RETURN_IF_ERROR(check_range(in.child("dielectric"), "roughness", glass.roughness, 0, 1));
      glass.priority = from.dielectric().priority();
      return glass;
    }
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
