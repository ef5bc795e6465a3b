#pragma once

// An image: linear RGB, float, rows from the top.

#include <cstdint>
#include <vector>

#include "renderlib/math/rgb.h"

namespace bandsaw {

struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<Rgb> pixels;  ///< width x height

  const Rgb& at(std::uint32_t x, std::uint32_t y) const {
    return pixels[static_cast<std::size_t>(y) * width + x];
  }
};

}  // namespace bandsaw
