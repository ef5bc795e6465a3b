#pragma once

// Images as textures: texels, wrapping, filtering.

#include "renderlib/texture/texture.h"

namespace bandsaw {

Rgb evaluate(const ImageTexture& image, const TextureCoordinates& at);
/// 1 where texels have 8 bits.
float max_value(const ImageTexture& image);
Rgb mean(const ImageTexture& image);

}  // namespace bandsaw
