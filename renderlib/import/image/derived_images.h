#pragma once

// Images that are not what a texture needs, and become it when they are read: heights, amounts of
// reflection.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The normals of a surface whose heights are the image's mean channel: codes over 255 as they
/// stand, floats as they are. `strength` is how many texels high a height of 1 is; finite. Slopes
/// are central differences, at the borders as the image wraps (Blinn 1978, "Simulation of Wrinkled
/// Surfaces"). Floats: a step of one code is a slope that 8 bits do not hold.
ImageTexture normals_of_heights(const ImageTexture& heights, double strength);

/// What index_map needs so that F0, the reflectance along the normal, is that of `index` (> 1)
/// times the luminance of the image: one channel of 8 bits, or of floats where the image has
/// floats.
ImageTexture index_map_of_reflectance(const ImageTexture& amounts, double index);

}  // namespace bandsaw
