#include "renderlib/import/image/texture_store.h"

#include <array>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/image/derived_images.h"

namespace bandsaw {
namespace {

// Texels times factor. 8-bit texels are multiplied in linear values and rounded to a code again: at
// most half a code off.
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
  ASSIGN_OR_RETURN(const std::string bytes, read());
  std::vector<std::string> warnings;
  // A grey image stays one unless it is tinted.
  const bool tints = use.factor.r != use.factor.g || use.factor.g != use.factor.b;
  auto image = use.alpha ? decode_alpha(bytes)
                         : decode_image(bytes, warnings, tints ? Gray::kExpanded : Gray::kKept);
  if (!image.ok()) {
    return absl::Status(image.status().code(), absl::StrCat(name, ": ", image.status().message()));
  }
  for (const std::string& warning : warnings) {
    if (use.alpha_is_known && warning == kAlphaWarning) {
      continue;
    }
    warnings_.push_back(absl::StrCat(name, ": ", warning));
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
  const TextureId id = add(*std::move(image));
  images_[whole] = id;
  return id;
}

}  // namespace bandsaw
