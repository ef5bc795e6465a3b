#pragma once

// A scene file as text for people.

#include <string>
#include <vector>

#include "proto/scene.pb.h"

namespace bandsaw {

/// Returns the scene in protobuf text format: a field a line, messages that fit on one line of 100
/// characters on one. The first lines are comments: `source`, the name of the file that was
/// converted, and the warnings.
std::string text_of(const scene::Scene& scene, const std::string& source,
                    const std::vector<std::string>& warnings);

}  // namespace bandsaw
