#pragma once

// Environment maps for tests.

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/texture/texture.h"

namespace bandsaw::test {

/// Makes a grey float image from these texels; (0, 0) is the top left.
ImageTexture float_image(std::uint32_t width, std::uint32_t height,
                         absl::FunctionRef<float(std::uint32_t, std::uint32_t)> texel);

}  // namespace bandsaw::test
