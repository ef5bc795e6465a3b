#pragma once

#include <string>

namespace bandsaw::gallery {

/// A pergola over a pool as glTF: one cube, placed as pillars, beams and slats; lengths in metres.
/// Its cameras: "gate" and "corner", two nodes that share the camera "walker", and "plan",
/// orthographic, from above.
std::string pergola();

}  // namespace bandsaw::gallery
