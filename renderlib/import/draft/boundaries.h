#pragma once

// Makes boundaries of media: closed meshes that separate a medium, such as smoke or the inside of
// glass, from its surroundings. They are used for models that a scene file fills with a medium,
// and for glass of glTF.

#include <optional>

#include "renderlib/import/draft/scene_draft.h"

namespace bandsaw {

/// Makes a boundary, filled with the medium `inside`, from an instance of a mesh of the scene. Adds
/// the mesh, with its normals outwards, to the meshes of Media::boundaries, unless it is already
/// there. Returns an instance of that mesh at the place of `placed`. The caller adds this instance
/// to Media::boundaries. Returns std::nullopt if the mesh is not closed.
std::optional<Instance> mesh_boundary(const Instance& placed, MediumId inside, SceneDraft& draft);

}  // namespace bandsaw
