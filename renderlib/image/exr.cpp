#include "renderlib/image/exr.h"

#include <tinyexr.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

constexpr std::size_t kChannels = 3;
constexpr float kMostHalf = 65504;

struct Free {
  void operator()(unsigned char* bytes) const { std::free(bytes); }
};

/// The channels one by one in the order of their names, as the format wants them: B, G, R.
struct Planes {
  explicit Planes(const Image& image, bool half) {
    for (std::vector<float>& plane : values) {
      plane.reserve(image.pixels.size());
    }
    for (const Rgb& pixel : image.pixels) {
      const std::array<float, kChannels> channels = {pixel.b, pixel.g, pixel.r};
      for (std::size_t c = 0; c < kChannels; ++c) {
        const float value = channels[c];
        values[c].push_back(half ? std::clamp(value, -kMostHalf, kMostHalf) : value);
      }
    }
  }
  std::array<std::vector<float>, kChannels> values;
};

}  // namespace

absl::StatusOr<std::vector<std::byte>> encode_exr(const Image& image, bool half) {
  Planes planes(image, half);
  std::array<unsigned char*, kChannels> data{};
  std::array<EXRChannelInfo, kChannels> channels{};
  std::array<int, kChannels> in_memory{};
  std::array<int, kChannels> in_file{};
  for (std::size_t c = 0; c < kChannels; ++c) {
    data[c] = reinterpret_cast<unsigned char*>(planes.values[c].data());
    channels[c].name[0] = "BGR"[c];
    in_memory[c] = TINYEXR_PIXELTYPE_FLOAT;
    in_file[c] = half ? TINYEXR_PIXELTYPE_HALF : TINYEXR_PIXELTYPE_FLOAT;
  }
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = kChannels;
  header.channels = channels.data();
  header.pixel_types = in_memory.data();
  header.requested_pixel_types = in_file.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage picture;
  InitEXRImage(&picture);
  picture.num_channels = kChannels;
  picture.images = data.data();
  picture.width = static_cast<int>(image.width);
  picture.height = static_cast<int>(image.height);
  unsigned char* raw = nullptr;
  const char* error = nullptr;
  const std::size_t size = SaveEXRImageToMemory(&picture, &header, &raw, &error);
  const std::unique_ptr<unsigned char, Free> bytes(raw);
  if (size == 0 || bytes == nullptr) {
    const absl::Status status = absl::ResourceExhaustedError(absl::StrCat(
        "the image cannot be encoded as EXR (", error == nullptr ? "too large" : error, ")"));
    FreeEXRErrorMessage(error);
    return status;
  }
  std::vector<std::byte> out(size);
  std::memcpy(out.data(), bytes.get(), size);
  return out;
}

}  // namespace bandsaw
