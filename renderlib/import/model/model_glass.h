#pragma once

// Solid glass of glTF: KHR_materials_transmission with KHR_materials_volume.

#include <optional>
#include <vector>

#include "renderlib/import/model/material_reader.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {

/// The glass that a material is where it bounds a volume: smooth or rough, with what it absorbs.
/// Nothing where it has no volume, or is not as a whole transparent; that it has a volume is then a
/// warning.
std::optional<ModelMaterial::Glass> glass_of(MaterialReader& reader, const Principled& material);

/// Makes glass of what of `model` has such a material and is closed. What is open stays a thin
/// pane, with a warning.
void fill_glass(const std::vector<ModelMaterial>& materials, ModelFile& file, Model& model);

}  // namespace bandsaw
