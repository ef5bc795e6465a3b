#pragma once

// Reads the solid glass of glTF: materials with KHR_materials_transmission and
// KHR_materials_volume.

#include <optional>
#include <vector>

#include "renderlib/import/model/material_reader.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {

/// Returns the glass of `material`, a MetallicRoughness that bounds a volume. The glass is smooth
/// or rough, and has the absorption of the volume. The index of refraction of `material` includes
/// the effect of KHR_materials_specular, which changes only the reflection. The index of the glass
/// is `index_of_refraction`, which does not include this effect. Returns std::nullopt if the
/// material has no volume or no transmission. Returns std::nullopt with a warning if the material
/// is not fully transmissive, is a metal or is not opaque.
std::optional<ModelMaterial::Glass> glass_of(MaterialReader& reader, const Material& material,
                                             double index_of_refraction);

/// Gives the closed meshes of `model` the glass of their material, with a medium inside if the
/// glass absorbs light. Open meshes stay thin panes, with a warning. `materials` have Assimp's
/// order.
void fill_glass(const std::vector<ModelMaterial>& materials, ModelFile& file, Model& model);

}  // namespace bandsaw
