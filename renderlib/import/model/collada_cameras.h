#pragma once

// Reads the lenses of the cameras of a COLLADA file from its XML. Assimp's own lenses are not used:
// Assimp 5.2 reads the size of an orthographic camera as an angle, and computes wrong angles for
// some perspective cameras.

#include <map>
#include <optional>
#include <string>

#include "absl/strings/string_view.h"

namespace bandsaw {

/// The lens of a camera; at most one field is set.
struct ColladaLens {
  std::optional<double> vertical_fov;  ///< in radians, of a perspective camera
  std::optional<double> height;        ///< of an orthographic camera, in units of its node
};

/// Returns true if the name ends with .dae, in upper or lower case.
bool is_collada(absl::string_view path);

/// Lenses keyed by the name that Assimp gives the camera's node: the id of the node, or its sid if
/// it has no id.
using ColladaLenses = std::map<std::string, ColladaLens>;

/// Returns the lenses in the XML `text` of a file. A lens without a valid size or angle is left
/// out. If the XML is damaged, the lenses that cannot be found are left out.
ColladaLenses read_collada_lenses(absl::string_view text);

}  // namespace bandsaw
