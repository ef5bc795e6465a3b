#pragma once

// Surfaces of revolution in the scene `room`, as the text of OBJ files; lengths in centimetres.

#include <string>

namespace bandsaw::gallery {

std::string vase();
std::string pawn();
std::string lamp_foot();   ///< the foot and the pole of a desk lamp, 34 high
std::string lamp_shade();  ///< open below and above, 2 mm thick; its lower rim lies at y = 0

}  // namespace bandsaw::gallery
