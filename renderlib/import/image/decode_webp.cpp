// Decodes WebP images by libwebp.

#include "renderlib/import/image/decode_webp.h"

#include <webp/decode.h>

#include "absl/strings/match.h"

namespace bandsaw {
namespace {

const std::uint8_t* webp_data(absl::string_view bytes) {
  return reinterpret_cast<const std::uint8_t*>(bytes.data());
}

absl::Status damaged() {
  return absl::InvalidArgumentError(
      "is a WebP image that is damaged or truncated; save it again, or as PNG");
}

}  // namespace

bool is_webp(absl::string_view bytes) {
  return absl::StartsWith(bytes, "RIFF") && bytes.size() >= 12 && bytes.substr(8, 4) == "WEBP";
}

absl::StatusOr<WebpHeader> webp_header(absl::string_view bytes) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(webp_data(bytes), bytes.size(), &features) != VP8_STATUS_OK) {
    return damaged();
  }
  if (features.has_animation != 0) {
    return absl::InvalidArgumentError(
        "is an animated WebP image, but a texture must be a single image; save one of its frames");
  }
  return WebpHeader{features.width, features.height, features.has_alpha != 0};
}

absl::StatusOr<std::shared_ptr<std::uint8_t>> decode_webp(absl::string_view bytes, int channels) {
  int width = 0;
  int height = 0;
  std::uint8_t* pixels = channels == 4
                             ? WebPDecodeRGBA(webp_data(bytes), bytes.size(), &width, &height)
                             : WebPDecodeRGB(webp_data(bytes), bytes.size(), &width, &height);
  if (pixels == nullptr) {
    return damaged();
  }
  return std::shared_ptr<std::uint8_t>(pixels, [](std::uint8_t* p) { WebPFree(p); });
}

}  // namespace bandsaw
