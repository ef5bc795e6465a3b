#pragma once

// Converts lights of a model file to delta lights: lights from a point or from one direction.

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_file.h"

struct aiLight;

namespace bandsaw {

/// Appends the light `from` of a node to `model.lights`. `node` is the node's transform to the
/// model's space. Area and ambient lights are omitted, with a warning. The result of a point or
/// spot light falls off with the square of the distance. If the file gives a different falloff,
/// only the intensity at distance 1 is kept, with a warning.
void add_model_light(const aiLight& from, const Transform& node, ModelFile& file, Model& model);

}  // namespace bandsaw
