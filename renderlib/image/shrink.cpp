// Each pixel of the smaller image is the mean of the pixels that it covers.

#include "renderlib/image/shrink.h"

#include <algorithm>

namespace bandsaw {
namespace {

/// Returns the mean of the pixels in columns [left, right) and rows [top, bottom).
Rgb mean(const Image& image, std::uint32_t left, std::uint32_t top, std::uint32_t right,
         std::uint32_t bottom) {
  double r = 0;
  double g = 0;
  double b = 0;
  for (std::uint32_t y = top; y < bottom; ++y) {
    for (std::uint32_t x = left; x < right; ++x) {
      const Rgb& pixel = image.at(x, y);
      r += pixel.r;
      g += pixel.g;
      b += pixel.b;
    }
  }
  const double n = double{1} * (right - left) * (bottom - top);
  return {static_cast<float>(r / n), static_cast<float>(g / n), static_cast<float>(b / n)};
}

}  // namespace

Image shrunk(const Image& image, std::uint32_t across, std::uint32_t down) {
  if (across == 1 && down == 1) {
    return image;
  }
  Image out{.width = (image.width + across - 1) / across,
            .height = (image.height + down - 1) / down,
            .pixels = {}};
  out.pixels.reserve(std::size_t{out.width} * out.height);
  for (std::uint32_t y = 0; y < out.height; ++y) {
    for (std::uint32_t x = 0; x < out.width; ++x) {
      out.pixels.push_back(mean(image, x * across, y * down,
                                std::min(image.width, (x + 1) * across),
                                std::min(image.height, (y + 1) * down)));
    }
  }
  return out;
}

}  // namespace bandsaw
