#pragma once

// Small pictures for the tests of this folder, which compare images.

#include <cmath>
#include <cstdint>

#include "renderlib/image/image.h"
#include "tests/support/random.h"

namespace bandsaw::test {

/// Returns an image whose pixels are all `color`.
inline Image uniform(std::uint32_t width, std::uint32_t height, const Rgb& color) {
  Image out{.width = width, .height = height, .pixels = {}};
  out.pixels.assign(std::size_t{width} * height, color);
  return out;
}

inline Image uniform(std::uint32_t width, std::uint32_t height, float value) {
  return uniform(width, height, gray(value));
}

/// Returns a smooth picture in grey between 0.2 and 0.8.
inline Image waves(std::uint32_t width, std::uint32_t height) {
  Image out = uniform(width, height, 0.0F);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      out.pixels[std::size_t{y} * width + x] =
          gray(0.5F + 0.3F * static_cast<float>(std::sin(0.2 * x) * std::cos(0.15 * y)));
    }
  }
  return out;
}

}  // namespace bandsaw::test
