#pragma once

// Animations of the formats that Assimp reads, except for glTF (gltf/gltf_animation.h).

#include <cstddef>
#include <string>
#include <vector>

#include "renderlib/import/animation/animation.h"

struct aiScene;

namespace bandsaw {

/// Returns the names of the animations, in the order of the file; may be empty or shared.
std::vector<std::string> animation_names(const aiScene& scene);

/// Returns animation number `index`, which MUST exist, with times in seconds. Nodes are found by
/// name; if several share one, it is the first. Keys that are not finite or not in order are left
/// out.
Animation read_animation(const aiScene& scene, std::size_t index);

}  // namespace bandsaw
