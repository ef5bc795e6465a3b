// Copies the channels to planes, converts them to halves if requested, and passes them to tinyexr.

#include "renderlib/image/exr.h"

#include <tinyexr.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

constexpr float kMaxHalf = 65504;
/// Maximum length of a layer's name, in bytes. A channel's name has at most 255 bytes, and its
/// suffix needs two of them.
constexpr std::size_t kMaxLayerName = 200;

/// Frees memory of tinyexr, which allocates by malloc.
struct Free {
  void operator()(unsigned char* bytes) const { std::free(bytes); }
};

/// A channel of the file.
struct Channel {
  std::string name;
  bool half = false;  ///< stored as halves
  std::vector<float> values;
};

/// Returns one component of all pixels as a channel; the pointer `of` selects the component. If
/// `half` is true, the values are clamped to the range of halves.
Channel channel(const std::string& name, const Image& image, float Rgb::*of, bool half) {
  Channel to{name, half, {}};
  to.values.reserve(image.pixels.size());
  for (const Rgb& pixel : image.pixels) {
    const float value = pixel.*of;
    to.values.push_back(half ? std::clamp(value, -kMaxHalf, kMaxHalf) : value);
  }
  return to;
}

/// Returns the channels of the image and of its layers, sorted by name, as the format requires.
std::vector<Channel> channels_of(const Image& image, bool half, const Layers& layers) {
  std::vector<Channel> channels;
  const auto add = [&](const std::string& prefix, const Image& from) {
    channels.push_back(channel(prefix + "B", from, &Rgb::b, half));
    channels.push_back(channel(prefix + "G", from, &Rgb::g, half));
    channels.push_back(channel(prefix + "R", from, &Rgb::r, half));
  };
  add("", image);
  for (const Layer& layer : layers) {
    if (layer.is_number) {
      channels.push_back(channel(layer.name + ".Z", layer.image, &Rgb::r, false));
    } else {
      add(layer.name + ".", layer.image);
    }
  }
  std::sort(channels.begin(), channels.end(),
            [](const Channel& a, const Channel& b) { return a.name < b.name; });
  return channels;
}

}  // namespace

std::uint64_t beyond_half(const Image& image) {
  std::uint64_t count = 0;
  for (const Rgb& pixel : image.pixels) {
    for (const float value : {pixel.r, pixel.g, pixel.b}) {
      count += std::abs(value) > kMaxHalf ? 1 : 0;
    }
  }
  return count;
}

absl::StatusOr<std::vector<std::byte>> encode_exr(const Image& image, bool half,
                                                  const Layers& layers) {
  for (const Layer& layer : layers) {
    if (layer.image.pixels.size() != image.pixels.size()) {
      return absl::InvalidArgumentError(
          absl::StrCat("the layer ", layer.name, " is not as large as the image"));
    }
    if (layer.name.size() > kMaxLayerName) {
      return absl::InvalidArgumentError(absl::StrCat("the name of a layer has ", layer.name.size(),
                                                     " bytes, at most ", kMaxLayerName,
                                                     " are allowed"));
    }
  }
  std::vector<Channel> channels = channels_of(image, half, layers);
  std::vector<unsigned char*> data;
  std::vector<EXRChannelInfo> infos;
  std::vector<int> in_file;
  std::vector<int> in_memory(channels.size(), TINYEXR_PIXELTYPE_FLOAT);
  for (Channel& one : channels) {
    data.push_back(reinterpret_cast<unsigned char*>(one.values.data()));
    EXRChannelInfo info{};
    one.name.copy(info.name, sizeof info.name - 1);
    infos.push_back(info);
    in_file.push_back(one.half ? TINYEXR_PIXELTYPE_HALF : TINYEXR_PIXELTYPE_FLOAT);
  }
  EXRHeader header;
  InitEXRHeader(&header);
  header.num_channels = static_cast<int>(channels.size());
  header.channels = infos.data();
  header.pixel_types = in_memory.data();
  header.requested_pixel_types = in_file.data();
  header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;
  EXRImage picture;
  InitEXRImage(&picture);
  picture.num_channels = header.num_channels;
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
