#pragma once

// The surfaces that media are inside of.

#include <optional>

#include "renderlib/import/draft/scene_draft.h"

namespace bandsaw {

/// The placed mesh of the scene as an instance of Media::boundaries with `inside` in it, turned
/// outwards. Nothing where the mesh is open.
std::optional<Instance> mesh_boundary(const Instance& placed, MediumId inside, SceneDraft& draft);

}  // namespace bandsaw
