#pragma once

// Delta lights of a model file.

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_file.h"

struct aiLight;

namespace bandsaw {

/// Appends the light of a node with this transform. Lights that are not supported (area or ambient
/// lights, other falloffs than with the square of the distance) are omitted or approximated with a
/// warning.
void add_model_light(const aiLight& from, const Transform& node, ModelFile& file, Model& model);

}  // namespace bandsaw
