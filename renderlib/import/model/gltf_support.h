#pragma once

#include <string>
#include <vector>

#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw {

/// The extensions that the file uses and that change nothing here.
std::vector<std::string> ignored_extensions(const gltf::Json& root);

}  // namespace bandsaw
