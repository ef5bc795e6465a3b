#pragma once

// The smoke and the fire of the scene `campfire`, as *.vol files of 8 bits a number.

#include <string>

namespace bandsaw::gallery {

/// Density, at most 1: smoke that rises and drifts, in the box from [-1.2, 0, -1] to [1.8, 4, 1].
std::string smoke_volume();
/// Flames in the box from [-0.5, 0, -0.5] to [0.5, 1.5, 0.5]: how hot they are, at most 1.
std::string flame_volume();

}  // namespace bandsaw::gallery
