#pragma once

// Meshes of the scenes in gallery/hard_light (scenes whose light is hard to find), as the text of
// OBJ files.

#include <string>

namespace bandsaw::gallery {

/// Returns a finger ring of radius 0.8 that lies on y = 0, 0.42 high, with a rounded profile.
std::string ring();

/// Returns the surface of water over [-2, 2]^2 about y = 0: a sum of five waves, with smooth
/// normals.
std::string waves();

}  // namespace bandsaw::gallery
