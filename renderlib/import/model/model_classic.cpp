// Reads the older kind of materials (Kd, Ks, Ns, Ke, Ni, d) of OBJ, FBX, DAE, 3DS and other
// formats.

#include <assimp/material.h>

#include <algorithm>
#include <cmath>

#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/model/material_reader.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {
namespace {

using As = MaterialReader::As;
using Slot = MaterialReader::Slot;
constexpr float kMaxRadiance = 1e30f;

/// The values of the material. Implausible values have been replaced.
struct Classic {
  Rgb base;
  bool textured = false;        ///< the base colour has a texture
  Rgb specular;                 ///< black if there is no highlight
  double exponent = 0;          ///< exponent of Blinn's highlight
  std::optional<double> index;  ///< index of refraction, if the file has one above 1
  Rgb glow;
  bool glow_map = false;
  double opacity = 1;
  bool opacity_map = false;
};

// Returns false if the exponent or the illumination model disables the highlight; many exporters
// write the highlight's colour nevertheless.
bool shines(const MaterialReader& reader, double exponent) {
  int model = aiShadingMode_Phong;
  reader.material().Get(AI_MATKEY_SHADING_MODEL, model);
  const bool matte = model == aiShadingMode_Flat || model == aiShadingMode_Gouraud ||
                     model == aiShadingMode_NoShading || model == aiShadingMode_OrenNayar ||
                     model == aiShadingMode_Minnaert;
  // MTL's illumination models have a highlight from number 2 on. Assimp knows only 0 to 2.
  int mtl_model = 0;
  reader.material().Get("$mat.illum", 0, 0, mtl_model);
  return (!matte || mtl_model >= 2) && exponent >= 1 && reader.kind() != ModelKind::kPlain;
}

// Returns the opacity. `mapped` says whether the material has an opacity map.
double opacity_of(MaterialReader& reader, bool mapped) {
  const double opacity = reader.number("$mat.opacity", 0, 1).value_or(1);
  if (opacity == 0 && !mapped) {
    // The most common mistake of exporters is to exchange transparency and opacity. So an opacity
    // of 0 is taken as 1.
    reader.unsupported("its opacity of 0 is taken as a mistake, and it is shown opaque");
    return 1;
  }
  return opacity;
}

// Returns the colour with which the texture and vertex colours are multiplied. A model without a
// colour is grey, or white if it has a texture or vertex colours, which grey would darken. In
// formats without materials Assimp's colour is ignored, because it is always white. `textured` says
// whether the colour has a texture.
Rgb base_color(const MaterialReader& reader, bool textured) {
  const bool painted = textured || reader.has_vertex_colors();
  const Rgb missing = painted ? Rgb{1, 1, 1} : gray(0.8f);
  if (reader.kind() == ModelKind::kPlain || (painted && reader.is_default_of_obj())) {
    return missing;
  }
  const Rgb base = reader.color("$clr.diffuse", 1).value_or(missing);
  // Some exporters write a black Kd to mean "the texture alone".
  return textured && is_black(base) ? Rgb{1, 1, 1} : base;
}

// Reads the numbers and colours of the material.
Classic read_numbers(MaterialReader& reader) {
  Classic from;
  from.textured = reader.has({aiTextureType_DIFFUSE}) || reader.has({aiTextureType_BASE_COLOR});
  from.base = base_color(reader, from.textured);
  from.exponent = reader.number("$mat.shininess", 0, 1e6).value_or(0);
  if (shines(reader, from.exponent)) {
    const double strength = reader.number("$mat.shinpercent", 0, 1).value_or(1);
    from.specular = reader.color("$clr.specular", 1).value_or(Rgb{}) * static_cast<float>(strength);
  }
  const double index = reader.number("$mat.refracti", 0, 5).value_or(0);
  from.index = index > 1 ? std::optional(index) : std::nullopt;
  from.glow = reader.color("$clr.emissive", kMaxRadiance).value_or(Rgb{});
  from.glow_map = reader.has({aiTextureType_EMISSIVE});
  from.glow = from.glow_map && is_black(from.glow) ? Rgb{1, 1, 1} : from.glow;
  from.opacity_map = reader.has({aiTextureType_OPACITY});
  from.opacity = opacity_of(reader, from.opacity_map);
  return from;
}

// Returns the roughness, the square root of the GGX alpha, whose highlight is as wide as
// (n.h)^exponent (Walter et al. 2007, section 5.1).
double roughness_of(double exponent) { return std::sqrt(std::sqrt(2 / (exponent + 2))); }

// Sets the metallic share, the roughness and the index of refraction. A black material with a
// highlight and without a texture is a metal of the highlight's colour.
void set_gloss(const Classic& from, MetallicRoughness& to) {
  to.metallic.factor = 0;
  to.roughness.factor = is_black(from.specular) ? 1 : roughness_of(from.exponent);
  if (!from.textured && is_black(from.base) && !is_black(from.specular)) {
    to.metallic.factor = 1;
    to.base_color.factor = from.specular;
    return;
  }
  // A material that is not a metal reflects little, whatever Ks is. If it has a highlight and an
  // index, the index is used. Otherwise F0 is the luminance of the highlight's colour, but at most
  // 0.04 as for glass. From r = sqrt(F0) the index follows as (1 + r) / (1 - r).
  constexpr double kGlass = 0.04;
  const double r = std::sqrt(std::min(kGlass, double{luminance(from.specular)}));
  to.index_of_refraction = !is_black(from.specular) && from.index ? *from.index : (1 + r) / (1 - r);
}

// Reads the specular map as the base colour of a metal, or as the index map of another material. A
// specular map without a highlight is ignored.
absl::Status read_specular_map(MaterialReader& reader, const Classic& from, MetallicRoughness& to) {
  const Slot slot{aiTextureType_SPECULAR};
  if (!reader.has(slot) || is_black(from.specular)) {
    return absl::OkStatus();
  }
  if (to.metallic.factor == 1) {
    ASSIGN_OR_RETURN(to.base_color.texture, reader.map(slot, As::kColor));
  } else if (to.index_of_refraction > 1) {
    ASSIGN_OR_RETURN(to.index_map, reader.index_map(slot, to.index_of_refraction));
  }
  return absl::OkStatus();
}

// Reads the normal map, or makes one from the height map. A height map that contains normals is
// used as a normal map.
absl::Status read_bump(MaterialReader& reader, Relief& to) {
  Slot slot{aiTextureType_NORMALS};
  if (!reader.has(slot)) {
    slot = {aiTextureType_HEIGHT};
    if (reader.has(slot) && !reader.holds_normals(slot)) {
      ASSIGN_OR_RETURN(to.normal, reader.bump_map(slot));
      return absl::OkStatus();
    }
  }
  if (reader.has(slot)) {
    ASSIGN_OR_RETURN(to.normal, reader.map(slot, As::kNumber));
  }
  return absl::OkStatus();
}

// Returns true if the material becomes Emissive: it emits, and its reflection is negligible.
bool is_lamp(const Classic& from) {
  return !is_black(from.glow) && !from.textured && !from.glow_map && is_black(from.specular) &&
         (max_component(from.glow) >= 1 || is_black(from.base));
}

}  // namespace

absl::StatusOr<ModelMaterial> read_classic(MaterialReader& reader) {
  const Classic from = read_numbers(reader);
  if (is_lamp(from)) {
    return reader.add(Emissive{reader.draft().textures.constant(from.glow), /*one_sided=*/false});
  }
  const Slot slot{reader.has({aiTextureType_DIFFUSE}) ? aiTextureType_DIFFUSE
                                                      : aiTextureType_BASE_COLOR};
  Material to;
  RETURN_IF_ERROR(read_bump(reader, to.relief));
  const bool see_through = from.opacity < 1 || from.opacity_map;
  if (is_black(from.specular) && is_black(from.glow) && !see_through && !to.relief.normal) {
    if (!reader.has(slot)) {
      return reader.add(Diffuse{reader.draft().textures.constant(from.base)});
    }
    ASSIGN_OR_RETURN(const TextureId texture, reader.map(slot, As::kColor, from.base));
    return reader.add(Diffuse{texture});
  }
  MetallicRoughness layers;
  ASSIGN_OR_RETURN(layers.base_color.texture, reader.map(slot, As::kColor));
  layers.base_color.factor = from.base;
  ASSIGN_OR_RETURN(const TextureId white, reader.white());
  layers.metallic.texture = layers.roughness.texture = layers.coat.texture = white;
  layers.coat_roughness.texture = layers.transmission.texture = white;
  set_gloss(from, layers);
  RETURN_IF_ERROR(read_specular_map(reader, from, layers));
  to.kind = layers;
  ASSIGN_OR_RETURN(to.emission.radiance.texture, reader.map({aiTextureType_EMISSIVE}, As::kColor));
  to.emission.radiance.factor = from.glow;
  to.alpha.value.texture = white;
  if (see_through) {
    to.alpha.mode = AlphaMode::kBlend;
    to.alpha.value.factor = from.opacity;
    if (from.opacity_map) {
      ASSIGN_OR_RETURN(to.alpha.value.texture, reader.opacity_map({aiTextureType_OPACITY}));
    }
  }
  return reader.add(to);
}

}  // namespace bandsaw
