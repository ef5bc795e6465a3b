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

/// Returns the glass of a material (MetallicRoughness) that bounds a volume: smooth or rough, with
/// its absorption. `index_of_refraction` is the one that refracts: that of the material also has
/// the effect of KHR_materials_specular, which changes the reflection only. Returns std::nullopt if
/// the material has no volume or is not fully transmissive; the latter adds a warning.
std::optional<ModelMaterial::Glass> glass_of(MaterialReader& reader, const Material& material,
                                             double index_of_refraction);

/// Gives the closed meshes of `model` the glass of their material, with a medium inside if the
/// glass absorbs light. Open meshes stay thin panes, with a warning. `materials` have Assimp's
/// order.
void fill_glass(const std::vector<ModelMaterial>& materials, ModelFile& file, Model& model);

}  // namespace bandsaw
