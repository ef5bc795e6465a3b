#include "renderlib/import/image/derived_images.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "renderlib/image/srgb.h"

namespace bandsaw {
namespace {

using Format = ImageTexture::Format;
using Wrap = ImageTexture::Wrap;

/// A texel's channel: a code over 255, sRGB decoded if `decoded`, or a float.
double channel(const ImageTexture& image, std::size_t number, bool decoded) {
  if (image.format == Format::kFloat32) {
    float value = 0;
    std::memcpy(&value, image.texels.data() + number * sizeof(float), sizeof(float));
    return std::isfinite(value) ? value : 0;
  }
  const auto code = static_cast<std::size_t>(image.texels.data()[number]);
  return decoded && image.format == Format::kSrgb8 ? double{srgb_table()[code]}
                                                   : static_cast<double>(code) / 255;
}

/// The neighbour `by` (1 or -1) texels on, as the image goes on at its borders.
std::size_t neighbour(std::size_t at, int by, std::size_t count, Wrap wrap) {
  const std::size_t last = count - 1;
  if (by < 0 ? at > 0 : at < last) {
    return by < 0 ? at - 1 : at + 1;
  }
  return wrap == Wrap::kRepeat ? last - at : at;
}

/// The same image with other texels.
ImageTexture with_texels(const ImageTexture& image, Format format, std::uint8_t channels,
                         std::vector<std::byte> texels) {
  ImageTexture out = image;
  out.format = format;
  out.channels = channels;
  out.texels = std::move(texels);
  return out;
}

}  // namespace

ImageTexture normals_of_heights(const ImageTexture& heights, double strength) {
  const std::size_t width = heights.width;
  const std::size_t height = heights.height;
  const auto at = [&](std::size_t x, std::size_t y) {
    double sum = 0;
    for (std::size_t c = 0; c < heights.channels; ++c) {
      sum += channel(heights, (y * width + x) * heights.channels + c, false);
    }
    return sum / heights.channels;
  };
  std::vector<std::byte> texels(3 * sizeof(float) * width * height);
  std::byte* out = texels.data();
  for (std::size_t y = 0; y < height; ++y) {
    // Rows come from the top, v goes up.
    const std::size_t above = neighbour(y, -1, height, heights.v_wrap());
    const std::size_t below = neighbour(y, 1, height, heights.v_wrap());
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t right = neighbour(x, 1, width, heights.wrap);
      const std::size_t left = neighbour(x, -1, width, heights.wrap);
      const double du = strength * (at(right, y) - at(left, y)) / 2;
      const double dv = strength * (at(x, above) - at(x, below)) / 2;
      const double size = std::sqrt(1 + du * du + dv * dv);
      for (const double n : {-du / size, -dv / size, 1 / size}) {
        const auto value = static_cast<float>(0.5 + 0.5 * n);
        std::memcpy(out, &value, sizeof value);
        out += sizeof value;
      }
    }
  }
  return with_texels(heights, Format::kFloat32, 3, std::move(texels));
}

ImageTexture index_map_of_reflectance(const ImageTexture& amounts, double index) {
  const double root = (index - 1) / (index + 1);  // of F0
  const std::size_t count = std::size_t{amounts.width} * amounts.height;
  const bool floats = amounts.format == Format::kFloat32;
  std::vector<std::byte> texels(count * (floats ? sizeof(float) : 1));
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = [&](std::size_t c) {
      return channel(amounts, i * amounts.channels + (amounts.channels == 1 ? 0 : c), true);
    };
    const double amount = 0.2126 * value(0) + 0.7152 * value(1) + 0.0722 * value(2);
    const double f = root * std::sqrt(std::clamp(amount, 0.0, 1.0));
    const double share = 2 * f / (1 - f) / (index - 1);
    if (floats) {
      const auto stored = static_cast<float>(share);
      std::memcpy(texels.data() + i * sizeof stored, &stored, sizeof stored);
    } else {
      texels[i] = std::byte{static_cast<std::uint8_t>(255 * share + 0.5)};
    }
  }
  return with_texels(amounts, floats ? Format::kFloat32 : Format::kLinear8, 1, std::move(texels));
}

}  // namespace bandsaw
