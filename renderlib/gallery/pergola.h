#pragma once

#include <string>

namespace bandsaw::gallery {

/// Returns a pergola over a pool as glTF: one cube, placed as pillars, beams and slats; lengths in
/// metres. It has three cameras: "gate" and "corner", two nodes that share the camera "walker", and
/// "plan", an orthographic one from above.
std::string pergola();

}  // namespace bandsaw::gallery
