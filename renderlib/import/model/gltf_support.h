#pragma once

// What a glTF file uses, against what is read of it.

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/import/model/gltf_json.h"

namespace bandsaw {

/// Extensions that the file uses and that change nothing here.
std::vector<std::string> ignored_extensions(const gltf::Struct& root);

/// INVALID_ARGUMENT when its geometry or its textures cannot be read: an extension that it requires
/// puts other bytes in their place, or vertices that are not floats, whose bytes Assimp 5.2 would
/// take for floats.
absl::Status check_gltf_support(const gltf::Struct& root);

}  // namespace bandsaw
