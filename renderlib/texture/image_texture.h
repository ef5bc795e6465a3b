#pragma once

// Image textures: reads texels, wraps coordinates and filters. texture.h has the interface for all
// textures; environment maps use texel() directly.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns the linear colour of one texel; x < width from the left, y < height from the top.
Rgb texel(const ImageTexture& image, std::uint32_t x, std::uint32_t y);
/// Returns the filtered linear colour at the image's set of uvs.
Rgb evaluate(const ImageTexture& image, const TextureCoordinates& at);
/// Returns how many times the image repeats between two points whose coordinates differ by
/// `change`, in the direction (u or v of the image) with more repetitions; >= 0, not rounded. An
/// image that is clamped counts as if it repeated.
double repetitions(const ImageTexture& image, const TextureCoordinates& change);
/// Returns the largest value of any channel; always 1 for 8-bit texels.
float max_value(const ImageTexture& image);
/// Returns the mean linear colour of all texels.
Rgb mean(const ImageTexture& image);

}  // namespace bandsaw
