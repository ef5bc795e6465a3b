// Makes images of one float channel, mostly for environment maps. A function gives each texel.

#include "tests/support/environments.h"

#include <cstring>
#include <utility>
#include <vector>

namespace bandsaw::test {

ImageTexture float_image(std::uint32_t width, std::uint32_t height,
                         absl::FunctionRef<float(std::uint32_t, std::uint32_t)> texel) {
  ImageTexture image;
  image.width = width;
  image.height = height;
  image.channels = 1;
  image.format = ImageTexture::Format::kFloat32;
  std::vector<std::byte> texels(texel_bytes(image));
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const float value = texel(x, y);
      std::memcpy(texels.data() + (std::size_t{y} * width + x) * sizeof value, &value,
                  sizeof value);
    }
  }
  image.texels = std::move(texels);
  return image;
}

}  // namespace bandsaw::test
