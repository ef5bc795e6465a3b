#pragma once

// Images as textures: texels, wrapping, filtering.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The linear colour of one texel; x < width from the left, y < height from the top.
Rgb texel(const ImageTexture& image, std::uint32_t x, std::uint32_t y);
Rgb evaluate(const ImageTexture& image, const TextureCoordinates& at);
/// 1 where texels have 8 bits.
float max_value(const ImageTexture& image);
Rgb mean(const ImageTexture& image);

}  // namespace bandsaw
