#pragma once

// Writes a scene file as text that people read and edit, for `bandsaw import`.

#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bandsaw {

/// Returns the scene in protobuf text format. A message that fits into 100 characters gets one
/// line; otherwise each of its fields begins a line. The first lines are comments: the name of the
/// file that was converted (`source`), and the warnings.
std::string text_of(const scene::Scene& scene, const std::string& source,
                    const std::vector<std::string>& warnings);

}  // namespace bandsaw
