#pragma once

// Image textures: texels, wrapping, filtering.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the linear colour of one texel; x < width from the left, y < height from the top.
Rgb texel(const ImageTexture& image, std::uint32_t x, std::uint32_t y);
Rgb evaluate(const ImageTexture& image, const TextureCoordinates& at);
/// Returns the largest value; 1 for 8-bit texels.
float max_value(const ImageTexture& image);
Rgb mean(const ImageTexture& image);

}  // namespace bandsaw
