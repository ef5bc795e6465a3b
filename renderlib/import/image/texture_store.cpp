// Adds images to the imported scene as textures. An image is decoded, its texels are converted as
// its use requires (factor, normals from heights, index of refraction), and the texture is stored
// under the key of its image and use.

#include "renderlib/import/image/texture_store.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {
namespace {

using Format = ImageTexture::Format;
using Wrap = ImageTexture::Wrap;

/// Returns a value of the image: value number `number` of the list of all channels of all texels.
/// An 8-bit code of an sRGB image is decoded to a linear value if `decoded` is true; all other
/// codes are divided by 255. A float that is not finite becomes 0.
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

/// Returns the index of the neighbour at distance `by` (1 or -1), according to the wrap mode.
std::size_t neighbour(std::size_t at, int by, std::size_t count, Wrap wrap) {
  const std::size_t last = count - 1;
  if (by < 0 ? at > 0 : at < last) {
    return by < 0 ? at - 1 : at + 1;
  }
  return wrap == Wrap::kRepeat ? last - at : at;
}

/// Returns the same image with other texels.
ImageTexture with_texels(const ImageTexture& image, Format format, std::uint8_t channels,
                         std::vector<std::byte> texels) {
  ImageTexture out = image;
  out.format = format;
  out.channels = channels;
  out.texels = std::move(texels);
  return out;
}

/// Converts a height map to a normal map. The height is the image's mean channel: a code divided by
/// 255, or a float. `strength`, a finite number, is the height of the value 1, measured in texels
/// of the image. Slopes are central differences, with the image's wrap mode at the borders (Blinn
/// 1978, "Simulation of Wrinkled Surfaces"). The result is float, because 8 bits cannot represent
/// the slope of one code.
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
    // Rows are stored from the top; v increases upwards.
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

/// Converts an image to an index_map, which varies the index of refraction over a surface. The
/// image holds factors of F0, the reflectance along the normal. `index` (> 1) is the material's
/// index of refraction. With this index_map, the material's F0 at each point is the luminance of
/// the image, multiplied by the F0 that belongs to `index`. The result has one channel of 8 bits,
/// or of floats if the image has floats.
ImageTexture index_map_of_reflectance(const ImageTexture& amounts, double index) {
  const double root = (index - 1) / (index + 1);  // square root of F0
  const std::size_t count = std::size_t{amounts.width} * amounts.height;
  const bool floats = amounts.format == Format::kFloat32;
  std::vector<std::byte> texels(count * (floats ? sizeof(float) : 1));
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = [&](std::size_t c) {
      return channel(amounts, i * amounts.channels + (amounts.channels == 1 ? 0 : c), true);
    };
    const double amount = 0.2126 * value(0) + 0.7152 * value(1) + 0.0722 * value(2);
    const double f = root * std::sqrt(std::clamp(amount, 0.0, 1.0));
    // The index n = (1 + f) / (1 - f) has the F0 f^2. The map holds (n - 1) / (index - 1).
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

// Multiplies the texels by a factor. 8-bit texels are multiplied as linear values and rounded to
// the nearest code, with an error of at most half a code.
void scale(ImageTexture& image, const Rgb& factor) {
  if (factor == Rgb{1, 1, 1}) {
    return;
  }
  const std::array<float, 3> by{factor.r, factor.g, factor.b};
  const std::size_t channels = image.channels;
  std::vector<std::byte> texels(image.texels.begin(), image.texels.end());
  if (image.format == ImageTexture::Format::kFloat32) {
    for (std::size_t i = 0; i < texels.size() / sizeof(float); ++i) {
      float value = 0;
      std::memcpy(&value, texels.data() + i * sizeof(float), sizeof(float));
      value *= by[i % channels];
      std::memcpy(texels.data() + i * sizeof(float), &value, sizeof(float));
    }
  } else {
    std::array<std::array<std::byte, 256>, 3> table{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t code = 0; code < 256; ++code) {
        table[c][code] = std::byte{srgb_encode(srgb_table()[code] * by[c])};
      }
    }
    for (std::size_t i = 0; i < texels.size(); ++i) {
      texels[i] = table[i % channels][static_cast<std::size_t>(texels[i])];
    }
  }
  image.texels = std::move(texels);
}

/// Decodes the image file `bytes` and converts its texels as `use` requires.
absl::StatusOr<ImageTexture> converted_image(const std::string& bytes, const TextureStore::Use& use,
                                             std::vector<std::string>& warnings) {
  using Use = TextureStore::Use;
  // A grey image stays grey unless it is tinted.
  const bool tints = use.factor.r != use.factor.g || use.factor.g != use.factor.b;
  auto image = use.alpha ? decode_alpha(bytes)
                         : decode_image(bytes, warnings, tints ? Gray::kExpanded : Gray::kKept);
  if (!image.ok()) {
    return image.status();
  }
  image->wrap = use.wrap;
  image->filter = use.filter;
  image->uv_set = use.uv_set;
  image->uv_transform = use.uv_transform;
  image->wrap_v = use.wrap_v;
  scale(*image, use.factor);
  if (use.linear && image->format == ImageTexture::Format::kSrgb8) {
    image->format = ImageTexture::Format::kLinear8;
  }
  if (use.become == Use::Become::kNormals) {
    *image = normals_of_heights(*image, use.by);
  } else if (use.become == Use::Become::kIndexMap) {
    *image = index_map_of_reflectance(*image, use.by);
  }
  return image;
}

}  // namespace

TextureId TextureStore::add(Texture texture) {
  textures_.push_back(std::move(texture));
  return TextureId{static_cast<std::uint32_t>(textures_.size() - 1)};
}

TextureId TextureStore::constant(const Rgb& value) {
  const auto [known, is_new] = constants_.try_emplace({value.r, value.g, value.b}, TextureId{});
  if (is_new) {
    known->second = add(ConstantTexture{value});
  }
  return known->second;
}

absl::StatusOr<TextureStore::Decoded> TextureStore::decoded(
    const Key& whole, const std::string& name, const Use& use,
    absl::FunctionRef<absl::StatusOr<std::string>()> read) {
  if (memory_ != nullptr) {
    if (const Decoded* kept = memory_->find(whole)) {
      return *kept;
    }
  }
  ASSIGN_OR_RETURN(const std::string bytes, read());
  Decoded out;
  auto image = converted_image(bytes, use, out.warnings);
  if (!image.ok()) {
    return absl::Status(image.status().code(), absl::StrCat(name, ": ", image.status().message()));
  }
  out.image = *std::move(image);
  if (memory_ != nullptr) {
    memory_->set(whole, out);
  }
  return out;
}

absl::StatusOr<TextureId> TextureStore::image(
    const std::string& key, const std::string& name, const Use& use,
    absl::FunctionRef<absl::StatusOr<std::string>()> read) {
  const Key whole{key,
                  static_cast<int>(use.wrap),
                  static_cast<int>(use.filter),
                  {use.factor.r, use.factor.g, use.factor.b},
                  (use.linear ? 1 : 0) + (use.alpha ? 2 : 0) + 4 * static_cast<int>(use.become),
                  use.uv_set,
                  use.uv_transform.m,
                  use.wrap_v,
                  use.by};
  if (const auto known = images_.find(whole); known != images_.end()) {
    return known->second;
  }
  ASSIGN_OR_RETURN(Decoded image, decoded(whole, name, use, read));
  for (const std::string& warning : image.warnings) {
    if (use.alpha_is_known && warning == kAlphaWarning) {
      continue;
    }
    warnings_.push_back(absl::StrCat(name, ": ", warning));
  }
  const TextureId id = add(std::move(image.image));
  images_[whole] = id;
  return id;
}

}  // namespace bandsaw
