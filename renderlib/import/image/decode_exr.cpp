// Checks the size of an EXR image in its header, then decodes it by tinyexr to three floats for
// each pixel.

#include "renderlib/import/image/decode_exr.h"

#include <tinyexr.h>

#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

struct Free {
  void operator()(float* values) const { std::free(values); }
};

/// Takes ownership of the message.
absl::Status failure(const char* error) {
  const absl::Status status = absl::InvalidArgumentError(
      absl::StrCat("is not an EXR file that can be read, or is damaged (",
                   error == nullptr ? "unknown reason" : error, ")"));
  FreeEXRErrorMessage(error);
  return status;
}

absl::Status check_size(const unsigned char* data, std::size_t size) {
  EXRVersion version;
  if (ParseEXRVersionFromMemory(&version, data, size) != TINYEXR_SUCCESS) {
    return failure(nullptr);
  }
  if (version.multipart != 0 || version.non_image != 0) {
    return absl::InvalidArgumentError("is an EXR file of several parts or deep pixels: not read");
  }
  EXRHeader header;
  InitEXRHeader(&header);
  const char* error = nullptr;
  if (ParseEXRHeaderFromMemory(&header, &version, data, size, &error) != TINYEXR_SUCCESS) {
    return failure(error);
  }
  const std::int64_t width = std::int64_t{header.data_window.max_x} - header.data_window.min_x + 1;
  const std::int64_t height = std::int64_t{header.data_window.max_y} - header.data_window.min_y + 1;
  FreeEXRHeader(&header);
  constexpr std::int64_t kMax = kMaxTextureSide;
  if (width < 1 || height < 1 || width > kMax || height > kMax ||
      width * height > static_cast<std::int64_t>(kMaxPixels)) {
    return absl::InvalidArgumentError(
        absl::StrCat("is ", width, " x ", height, " pixels, at most ", kMaxPixels, " are read"));
  }
  return absl::OkStatus();
}

}  // namespace

bool is_exr(absl::string_view bytes) { return absl::StartsWith(bytes, "\x76\x2f\x31\x01"); }

absl::StatusOr<ImageTexture> decode_exr(absl::string_view bytes) {
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  RETURN_IF_ERROR(check_size(data, bytes.size()));
  float* raw = nullptr;
  int width = 0;
  int height = 0;
  const char* error = nullptr;
  const int result = LoadEXRFromMemory(&raw, &width, &height, data, bytes.size(), &error);
  const std::unique_ptr<float, Free> rgba(raw);
  if (result != TINYEXR_SUCCESS || rgba == nullptr) {
    return failure(error);
  }
  ImageTexture image;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.format = ImageTexture::Format::kFloat32;
  const std::size_t pixels = std::size_t{image.width} * image.height;
  std::vector<std::byte> texels(pixels * 3 * sizeof(float));
  for (std::size_t i = 0; i < pixels; ++i) {
    std::memcpy(texels.data() + i * 3 * sizeof(float), rgba.get() + i * 4, 3 * sizeof(float));
  }
  image.texels = std::move(texels);
  return image;
}

}  // namespace bandsaw
