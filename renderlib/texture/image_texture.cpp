// Maps uvs to texels by the wrap mode, then takes the nearest texel or interpolates between four.

#include "renderlib/texture/image_texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "renderlib/image/srgb.h"
#include "renderlib/texture/blend.h"

namespace bandsaw {
namespace {

/// Returns one channel of one texel as a linear value. `index` is its index among the channels of
/// all texels.
float value(const ImageTexture& image, std::size_t index) {
  if (image.format == ImageTexture::Format::kFloat32) {
    float value;
    std::memcpy(&value, image.texels.data() + index * sizeof(float), sizeof value);
    return value;
  }
  const auto code = std::to_integer<std::uint8_t>(image.texels[index]);
  return image.format == ImageTexture::Format::kSrgb8 ? srgb_table()[code]
                                                      : static_cast<float>(code) / 255.0f;
}

}  // namespace

Rgb texel(const ImageTexture& image, std::uint32_t x, std::uint32_t y) {
  const std::size_t index = (std::size_t{y} * image.width + x) * image.channels;
  const std::size_t step = image.channels == 1 ? 0 : 1;
  return {value(image, index), value(image, index + step), value(image, index + 2 * step)};
}

namespace {

/// Maps a coordinate to [0, 1] by the wrap mode. x - floor(x) may round up to 1, so wrapped_index()
/// wraps the index of the texel again.
double wrapped(double x, ImageTexture::Wrap wrap) {
  if (!std::isfinite(x)) {
    return 0;
  }
  switch (wrap) {
    case ImageTexture::Wrap::kRepeat:
      return x - std::floor(x);
    case ImageTexture::Wrap::kMirror: {
      const double in_period = x - 2 * std::floor(x / 2);
      return in_period <= 1 ? in_period : 2 - in_period;
    }
    case ImageTexture::Wrap::kClamp:
      break;
  }
  return std::clamp(x, 0.0, 1.0);
}

/// Returns the column or row of a texel for an index in [-1, size]. Beyond the edge of a mirrored
/// image, the neighbour of a texel is the texel itself.
std::uint32_t wrapped_index(std::int64_t i, std::uint32_t size, ImageTexture::Wrap wrap) {
  const std::int64_t last = std::int64_t{size} - 1;
  if (wrap == ImageTexture::Wrap::kRepeat) {
    return static_cast<std::uint32_t>(i < 0 ? last : i > last ? 0 : i);
  }
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, last));
}

/// Returns the texel at a point. x and y are in [0, 1], and y is measured from the top.
Rgb nearest(const ImageTexture& image, double x, double y) {
  const auto column = static_cast<std::int64_t>(std::floor(x * image.width));
  const auto row = static_cast<std::int64_t>(std::floor(y * image.height));
  return texel(image, wrapped_index(column, image.width, image.wrap),
               // At the bottom (v = 0), `row` equals the height, and the last row is taken.
               static_cast<std::uint32_t>(std::min<std::int64_t>(row, image.height - 1)));
}

/// Interpolates between the four texels whose centres surround a point; x and y as for nearest().
Rgb bilinear(const ImageTexture& image, double x, double y) {
  const double px = x * image.width - 0.5;
  const double py = y * image.height - 0.5;
  const double x0 = std::floor(px);
  const double y0 = std::floor(py);
  const auto column = static_cast<std::int64_t>(x0);
  const auto row = static_cast<std::int64_t>(y0);
  const std::uint32_t left = wrapped_index(column, image.width, image.wrap);
  const std::uint32_t right = wrapped_index(column + 1, image.width, image.wrap);
  const std::uint32_t top = wrapped_index(row, image.height, image.v_wrap());
  const std::uint32_t bottom = wrapped_index(row + 1, image.height, image.v_wrap());
  const auto fx = static_cast<float>(px - x0);
  const auto fy = static_cast<float>(py - y0);
  return blend(blend(texel(image, left, top), texel(image, right, top), fx),
               blend(texel(image, left, bottom), texel(image, right, bottom), fx), fy);
}

}  // namespace

std::uint64_t texel_bytes(const ImageTexture& image) {
  const bool floats = image.format == ImageTexture::Format::kFloat32;
  return std::uint64_t{image.width} * image.height * image.channels * (floats ? sizeof(float) : 1);
}

Rgb evaluate(const ImageTexture& image, const TextureCoordinates& at) {
  const Vec2 uv = image.uv_transform(at.of(image.uv_set));
  const double x = wrapped(uv.x, image.wrap);
  const double y = 1 - wrapped(uv.y, image.v_wrap());
  return image.filter == ImageTexture::Filter::kNearest ? nearest(image, x, y)
                                                        : bilinear(image, x, y);
}

// A repetition is one unit of a coordinate of the image, so the number of repetitions along u or v
// is the change of this coordinate under the linear part of the transform of the uvs.
double repetitions(const ImageTexture& image, const TextureCoordinates& change) {
  const auto& [a, b, c, d, e, f] = image.uv_transform.m;
  const Vec2& uv = change.of(image.uv_set);
  return std::max(std::abs(a * uv.x + b * uv.y), std::abs(d * uv.x + e * uv.y));
}

float max_value(const ImageTexture& image) {
  if (image.format != ImageTexture::Format::kFloat32) {
    return 1;
  }
  float most = 0;
  const std::size_t count = image.texels.size() / sizeof(float);
  for (std::size_t i = 0; i < count; ++i) {
    most = std::max(most, value(image, i));
  }
  return most;
}

Rgb mean(const ImageTexture& image) {
  double sum[3] = {0, 0, 0};
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      const Rgb value = texel(image, x, y);
      sum[0] += value.r;
      sum[1] += value.g;
      sum[2] += value.b;
    }
  }
  const double count = static_cast<double>(image.width) * image.height;
  return {static_cast<float>(sum[0] / count), static_cast<float>(sum[1] / count),
          static_cast<float>(sum[2] / count)};
}

}  // namespace bandsaw
