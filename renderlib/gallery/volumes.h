#pragma once

// The smoke and the fire of the scene `campfire`, as the content of *.vol files (grids of numbers,
// import/volume/vol_file.cpp) with 8 bits a number.

#include <string>

namespace bandsaw::gallery {

/// Returns the density of smoke that rises and drifts, at most 1, in the box from [-1.2, 0, -1] to
/// [1.8, 4, 1].
std::string smoke_volume();
/// Returns the temperature of flames, at most 1, in the box from [-0.5, 0, -0.5] to [0.5, 1.5,
/// 0.5].
std::string flame_volume();

}  // namespace bandsaw::gallery
