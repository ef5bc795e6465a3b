// Chooses how a material of a model is read: as unlit, metallic-roughness or an older kind. Adds
// warnings for textures that are not rendered.

#include "renderlib/import/model/model_material.h"

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/model/material_reader.h"

namespace bandsaw {
namespace {

// Adds a warning for each texture that is not rendered.
void warn_of_unused_textures(MaterialReader& reader) {
  constexpr struct {
    aiTextureType type;
    const char* what;
  } kUnused[] = {{aiTextureType_SHININESS, "shininess"},
                 {aiTextureType_REFLECTION, "reflection"},
                 {aiTextureType_DISPLACEMENT, "displacement"},
                 {aiTextureType_SHEEN, "sheen"}};
  for (const auto& [type, what] : kUnused) {
    // glTF's sheen has a warning already (GltfMaterial::unsupported).
    const bool is_named = type == aiTextureType_SHEEN && reader.kind() == ModelKind::kGltf;
    if (reader.has({type}) && !is_named) {
      reader.unsupported(absl::StrCat("its ", what, " map is left out"));
    }
  }
  // An occlusion map approximates how much light reaches a point; path tracing computes this light.
  if (reader.has({aiTextureType_LIGHTMAP}) || reader.has({aiTextureType_AMBIENT_OCCLUSION})) {
    reader.unsupported("its occlusion map is left out: light is followed instead");
  }
}

// A surface with KHR_materials_unlit is shown in its base colour under any light. Bandsaw has no
// such material. So the surface becomes diffuse, with the base colour and alpha of the material.
absl::StatusOr<ModelMaterial> read_unlit(MaterialReader& reader) {
  reader.unsupported("is unlit, which is taken as a diffuse surface");
  const Rgb base = reader.color("$clr.base", 1).value_or(Rgb{1, 1, 1});
  Diffuse surface;
  if (!reader.has({aiTextureType_BASE_COLOR})) {
    surface.reflectance = reader.draft().textures.constant(base);
  } else {
    ASSIGN_OR_RETURN(surface.reflectance,
                     reader.map({aiTextureType_BASE_COLOR}, MaterialReader::As::kColor, base));
  }
  Material to = surface;
  RETURN_IF_ERROR(read_alpha(reader, to.alpha));
  return reader.add(to);
}

}  // namespace

absl::StatusOr<ModelMaterial> read_model_material(ModelFile& file, unsigned index) {
  MaterialReader reader(file, index);
  warn_of_unused_textures(reader);
  if (reader.gltf() != nullptr) {
    for (const std::string& what : reader.gltf()->unsupported) {
      reader.unsupported(what);
    }
  }
  if (reader.gltf() != nullptr && reader.gltf()->unlit) {
    return read_unlit(reader);
  }
  const bool principled = file.kind == ModelKind::kGltf ||
                          reader.number("$mat.metallicFactor", 0, 1) ||
                          reader.has({aiTextureType_METALNESS});
  return principled ? read_metallic_roughness(reader) : read_classic(reader);
}

}  // namespace bandsaw
