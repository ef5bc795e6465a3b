// Encodes an image in the format that the suffix of its path names, and writes the file atomically
// (base/atomic_file.h).

#include "renderlib/image/write_image.h"

#include <bit>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/exr.h"
#include "renderlib/image/hdr.h"
#include "renderlib/image/png.h"
#include "renderlib/image/srgb.h"

namespace bandsaw {
namespace {

/// Returns the 8-bit sRGB codes (red, green, blue) of all pixels, with the display settings
/// applied.
std::vector<std::uint8_t> srgb_codes(const Image& image, const Display& display) {
  std::vector<std::uint8_t> codes;
  codes.reserve(image.pixels.size() * 3);
  for (const Rgb& light : image.pixels) {
    const Rgb pixel = shown(light, display);
    codes.push_back(srgb_encode(pixel.r));
    codes.push_back(srgb_encode(pixel.g));
    codes.push_back(srgb_encode(pixel.b));
  }
  return codes;
}

/// Returns the bytes of the header, followed by `payload` zeros for the pixels.
std::vector<std::byte> with_header(const std::string& header, std::size_t payload) {
  std::vector<std::byte> bytes(header.size() + payload);
  std::memcpy(bytes.data(), header.data(), header.size());
  return bytes;
}

std::vector<std::byte> encode_ppm(const Image& image, const Display& display) {
  const std::vector<std::uint8_t> codes = srgb_codes(image, display);
  const std::string header = absl::StrCat("P6\n", image.width, " ", image.height, "\n255\n");
  std::vector<std::byte> bytes = with_header(header, codes.size());
  if (!codes.empty()) {
    std::memcpy(bytes.data() + header.size(), codes.data(), codes.size());
  }
  return bytes;
}

/// Returns a PFM file, whose rows go from the bottom to the top.
std::vector<std::byte> encode_pfm(const Image& image) {
  static_assert(std::endian::native == std::endian::little && sizeof(Rgb) == 12,
                "pixels are written as they lie in memory");
  const std::string header = absl::StrCat("PF\n", image.width, " ", image.height, "\n-1.0\n");
  const std::size_t row_size = image.width * sizeof(Rgb);
  std::vector<std::byte> bytes = with_header(header, row_size * image.height);
  std::byte* to = bytes.data() + header.size();
  for (std::uint32_t y = image.height; y-- > 0; to += row_size) {
    std::memcpy(to, &image.pixels[std::size_t{y} * image.width], row_size);
  }
  return bytes;
}

}  // namespace

absl::StatusOr<ImageFormat> image_format_of(const std::string& path) {
  const std::string lower = absl::AsciiStrToLower(path);
  if (absl::EndsWith(lower, ".png")) {
    return ImageFormat::kPng;
  }
  if (absl::EndsWith(lower, ".ppm")) {
    return ImageFormat::kPpm;
  }
  if (absl::EndsWith(lower, ".pfm")) {
    return ImageFormat::kPfm;
  }
  if (absl::EndsWith(lower, ".hdr")) {
    return ImageFormat::kHdr;
  }
  if (absl::EndsWith(lower, ".exr")) {
    return ImageFormat::kExr;
  }
  return absl::InvalidArgumentError(
      absl::StrCat(path, ": the suffix of an image must be .png, .ppm, .pfm, .hdr or .exr"));
}

absl::StatusOr<std::vector<std::byte>> encode_image(const Image& image, ImageFormat format,
                                                    const Display& display, const Layers& layers) {
  if (image.width == 0 || image.height == 0 ||
      image.pixels.size() != std::size_t{image.width} * image.height) {
    return absl::InvalidArgumentError(absl::StrCat("cannot encode an image of ", image.width, " x ",
                                                   image.height, " from ", image.pixels.size(),
                                                   " pixels"));
  }
  switch (format) {
    case ImageFormat::kPng:
      return encode_png(image.width, image.height, srgb_codes(image, display));
    case ImageFormat::kPpm:
      return encode_ppm(image, display);
    case ImageFormat::kPfm:
      return encode_pfm(image);
    case ImageFormat::kHdr:
      return encode_hdr(image);
    case ImageFormat::kExr:
      return encode_exr(image, display.half, layers);
  }
  return absl::InvalidArgumentError("unknown image format");
}

absl::Status write_image(const Image& image, const std::string& path, const Display& display,
                         const Layers& layers) {
  ASSIGN_OR_RETURN(const ImageFormat format, image_format_of(path));
  ASSIGN_OR_RETURN(const std::vector<std::byte> bytes,
                   encode_image(image, format, display, layers));
  return write_file_atomically(path, bytes);
}

absl::Status check_writable(const std::string& path) {
  RETURN_IF_ERROR(image_format_of(path).status());
  return check_can_be_written(path);
}

}  // namespace bandsaw
