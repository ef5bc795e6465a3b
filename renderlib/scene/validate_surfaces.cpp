// Checks textures (sizes, number of texels, and values), then the materials that use them.

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/validate_field.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

absl::Status check_side(const std::string& field, std::uint32_t side) {
  return side >= 1 && side <= kMaxTextureSide
             ? absl::OkStatus()
             : invalid(field, absl::StrCat("must be in [1, ", kMaxTextureSide, "], is ", side));
}

absl::Status check_image(const std::string& field, const ImageTexture& image) {
  RETURN_IF_ERROR(check_side(field + ".width", image.width));
  RETURN_IF_ERROR(check_side(field + ".height", image.height));
  const std::uint64_t size = texel_bytes(image);
  if (image.texels.size() != size) {
    return invalid(field + ".texels",
                   absl::StrCat("must have ", size, " bytes for ", image.width, " x ", image.height,
                                " texels, has ", image.texels.size()));
  }
  if (image.format != ImageTexture::Format::kFloat32) {
    return absl::OkStatus();  // Decoded 8-bit values are always in [0, 1].
  }
  for (std::size_t i = 0; i < image.texels.size() / sizeof(float); ++i) {
    float value = 0;
    std::memcpy(&value, image.texels.data() + i * sizeof value, sizeof value);
    if (!std::isfinite(value) || value < 0) {
      const std::size_t texel = i / image.channels;
      return invalid(field + ".texels",
                     absl::StrCat("texel (", texel % image.width, ", ", texel / image.width,
                                  ") must be finite and not negative, is ", value));
    }
  }
  return absl::OkStatus();
}

absl::Status check_textures(const std::vector<Texture>& textures) {
  // The number of textures that one lookup evaluates, for each checked texture (check_parts).
  std::vector<std::uint64_t> cost;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const std::string field = item("textures", i);
    if (const absl::Status parts = check_parts(textures, i, cost); !parts.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(field, ".", parts.message()));
    }
    if (const auto* constant = std::get_if<ConstantTexture>(&textures[i])) {
      RETURN_IF_ERROR(check_color(field, constant->value, static_cast<float>(kInfinity)));
    }
    if (const auto* image = std::get_if<ImageTexture>(&textures[i])) {
      RETURN_IF_ERROR(check_image(field, *image));
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::Status check_surfaces(const SceneDescription& scene) {
  RETURN_IF_ERROR(check_textures(scene.textures));
  return check_materials(scene.materials, scene.textures);
}

}  // namespace bandsaw
