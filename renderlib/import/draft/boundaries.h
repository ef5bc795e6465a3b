#pragma once

// Makes boundaries of media: closed meshes that separate a medium, such as smoke or the inside of
// glass, from its surroundings. They are used for models of a scene file that a medium fills, and
// for glass of glTF.

#include <optional>

#include "renderlib/import/draft/scene_draft.h"

namespace bandsaw {

/// Returns the placed mesh of the scene as an instance of Media::boundaries that contains `inside`,
/// with its normals outwards; std::nullopt if the mesh is open.
std::optional<Instance> mesh_boundary(const Instance& placed, MediumId inside, SceneDraft& draft);

}  // namespace bandsaw
