// Reads solid glass of glTF. glass_of() makes the glass of a material with KHR_materials_volume.
// fill_glass() gives the glass, with a medium inside, to the closed meshes of the material.

#include "renderlib/import/model/model_glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "renderlib/geometry/closed.h"
#include "renderlib/import/draft/boundaries.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Returns the absorption of the volume per unit of length. White light that travels the
/// attenuation_distance gets the attenuation_color (law of Beer and Lambert).
Rgb absorption_of(const GltfVolume& volume) {
  const auto channel = [&](double color) {
    constexpr double kMinColor = 1e-6;  // darker colours are practically opaque
    const double rate =
        -log(std::clamp(color, kMinColor, 1.0)) / std::max(volume.attenuation_distance, 1e-12);
    return std::clamp(static_cast<float>(rate), 0.0f, kMaxPerUnit);
  };
  const auto [r, g, b] = volume.attenuation_color;
  return std::isfinite(volume.attenuation_distance) ? Rgb{channel(r), channel(g), channel(b)}
                                                    : Rgb{};
}

bool is_white(const Rgb& color) { return color == Rgb{1, 1, 1}; }

/// Returns true if the material has features that glass does not have.
bool has_more_than_glass(const MaterialReader& reader, const Material& material) {
  const auto& layers = std::get<MetallicRoughness>(material.kind);
  return !is_white(layers.base_color.factor) || reader.has({aiTextureType_BASE_COLOR}) ||
         reader.has({aiTextureType_UNKNOWN}) || material.relief.normal || layers.coat.factor > 0 ||
         !is_black(material.emission.radiance.factor);
}

/// Returns true if KHR_materials_specular changes the reflection.
bool has_effect(const GltfSpecular& specular) {
  return specular.factor != 1 || specular.color != std::array<double, 3>{1, 1, 1};
}

}  // namespace

std::optional<ModelMaterial::Glass> glass_of(MaterialReader& reader, const Material& material,
                                             double index_of_refraction) {
  const auto& layers = std::get<MetallicRoughness>(material.kind);
  const GltfMaterial* gltf = reader.gltf();
  if (gltf == nullptr || !gltf->volume || !(gltf->volume->thickness > 0) ||
      layers.transmission.factor == 0) {
    return std::nullopt;
  }
  const bool is_metal = layers.metallic.factor > 0 && !reader.has({aiTextureType_UNKNOWN});
  if (layers.transmission.factor < 1 || reader.has({aiTextureType_TRANSMISSION}) || is_metal ||
      material.alpha.mode != AlphaMode::kOpaque) {
    reader.unsupported("its volume is left out: light passes through it as through a thin pane");
    return std::nullopt;
  }
  if (has_more_than_glass(reader, material)) {
    reader.unsupported(
        "is solid glass: its base colour, its maps, its clear coat and its emission are left out");
  }
  if (gltf->specular && has_effect(*gltf->specular)) {
    reader.unsupported("is solid glass: its specular factor and colour are left out");
  }
  Dielectric glass;
  glass.index_of_refraction = index_of_refraction;
  glass.roughness = layers.roughness.factor;
  return ModelMaterial::Glass{reader.add(glass).id, absorption_of(*gltf->volume)};
}

void fill_glass(const std::vector<ModelMaterial>& materials, ModelFile& file, Model& model) {
  struct Filling {
    ModelMaterial::Glass glass;
    std::optional<MediumId> medium;
  };
  std::map<MaterialId, Filling> fillings;
  std::vector<Medium>& media = file.draft.out.scene.media.media;
  for (const ModelMaterial& material : materials) {
    if (material.glass && fillings.count(material.id) == 0) {
      Filling& filling = fillings[material.id];
      filling.glass = *material.glass;
      if (!is_black(filling.glass.absorption)) {
        filling.medium = MediumId{static_cast<std::uint32_t>(media.size())};
        media.push_back(Medium{.absorption = filling.glass.absorption});
      }
    }
  }
  std::size_t open = 0;
  for (Instance& instance : model.instances) {
    const auto found = fillings.find(instance.material);
    if (found == fillings.end()) {
      continue;
    }
    const Mesh& mesh = file.draft.out.scene.geometry.meshes[index_of(instance.mesh)];
    if (open_edges(mesh) > 0) {
      ++open;
      continue;
    }
    instance.material = found->second.glass.id;
    if (found->second.medium) {
      model.filled.push_back(*mesh_boundary(instance, *found->second.medium, file.draft));
    }
  }
  if (open > 0) {
    file.warn(absl::StrCat("the volume of ", open, " placements of meshes that are not closed is ",
                           "left out: light passes through them as through a thin pane"));
  }
}

}  // namespace bandsaw
