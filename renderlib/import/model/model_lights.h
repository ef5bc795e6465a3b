#pragma once

// Lights without size of a model file.

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_file.h"

struct aiLight;

namespace bandsaw {

/// Appends the light that stands at a node with this transform. What our lights cannot be (an area
/// or ambient light, another falloff than with the square of the distance) is left out or repaired
/// with a warning.
void add_model_light(const aiLight& from, const Transform& node, ModelFile& file, Model& model);

}  // namespace bandsaw
