#pragma once

// Writes a scene file as text that people read and edit, for `bandsaw import`.

#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bandsaw {

/// Returns the scene in protobuf text format: a line for each field, or for a whole message that
/// fits into 100 characters. The first lines are comments: the name of the file that was converted
/// (`source`), and the warnings.
std::string text_of(const scene::Scene& scene, const std::string& source,
                    const std::vector<std::string>& warnings);

}  // namespace bandsaw
