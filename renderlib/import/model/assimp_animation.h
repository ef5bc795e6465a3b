#pragma once

// Reads animations of models as Assimp stores them, except for those of glTF 2, which are read from
// its JSON (gltf/gltf_animation.h).

#include <cstddef>
#include <string>
#include <vector>

#include "renderlib/import/animation/animation.h"

struct aiScene;

namespace bandsaw {

/// Returns the names of the animations, in the order of the file. A name may be empty, and several
/// animations may share one.
std::vector<std::string> animation_names(const aiScene& scene);

/// Returns animation number `index`, which MUST exist, with times in seconds. Nodes are found by
/// name; of several nodes with the same name, the first moves. Keys that are not finite or not in
/// order are left out.
Animation read_animation(const aiScene& scene, std::size_t index);

}  // namespace bandsaw
