#pragma once

// Images for environment maps and textures of tests.

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/texture/texture.h"

namespace bandsaw::test {

/// Makes a grey float image whose texel at column x and row y is texel(x, y); (0, 0) is the top
/// left.
ImageTexture float_image(std::uint32_t width, std::uint32_t height,
                         absl::FunctionRef<float(std::uint32_t, std::uint32_t)> texel);

}  // namespace bandsaw::test
