#pragma once

#include <string>

namespace bandsaw::gallery {

/// Returns a pergola over a pool as glTF: one cube, placed as pillars, beams and slats. Lengths are
/// in metres. Three nodes have a camera: "gate" and "corner" share the perspective camera "walker",
/// and "plan" has an orthographic camera that looks down from above.
std::string pergola();

}  // namespace bandsaw::gallery
