#pragma once

// Reads the lenses of the cameras of a COLLADA file from its XML: Assimp 5.2 takes the size of an
// orthographic camera as an angle, and computes wrong angles of some perspective cameras.

#include <map>
#include <optional>
#include <string>

#include "absl/strings/string_view.h"

namespace bandsaw {

struct ColladaLens {
  std::optional<double> vertical_fov;  ///< in radians, of a perspective camera
  std::optional<double> height;        ///< of an orthographic camera, in units of its node
};

bool is_collada(absl::string_view path);

/// Lenses keyed by the names that Assimp gives their nodes: a node's id, or its sid.
using ColladaLenses = std::map<std::string, ColladaLens>;

/// Returns the lenses in the text of a file; those without a valid size or angle are left out.
ColladaLenses read_collada_lenses(absl::string_view text);

}  // namespace bandsaw
