#pragma once

// Reads the animations of a model from Assimp's result. Not used for glTF 2, whose animations are
// read from the file's JSON (gltf/gltf_animation.h).

#include <cstddef>
#include <string>
#include <vector>

#include "renderlib/import/animation/animation.h"

struct aiScene;

namespace bandsaw {

/// Returns the names of the animations, in the order of the file. A name may be empty, and several
/// animations may share a name.
std::vector<std::string> animation_names(const aiScene& scene);

/// Returns animation number `index`, which MUST exist, with times in seconds. Nodes are found by
/// name. If several nodes share a name, only the first one moves. Keys that are not finite or not
/// in order are left out.
Animation read_animation(const aiScene& scene, std::size_t index);

}  // namespace bandsaw
