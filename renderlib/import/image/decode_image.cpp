// Decodes image files of a scene. The first bytes tell the format. The decoder is stb_image,
// libwebp, tinyexr, or for PFM files the function decode_pfm() below.

#include "renderlib/import/image/decode_image.h"

#define STBI_NO_STDIO
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <utility>

#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/image.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_exr.h"
#include "renderlib/import/image/decode_webp.h"
#include "renderlib/render/settings.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

// Removes and returns the next word of the header, and removes one white-space character after it.
absl::string_view take_word(absl::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && !absl::ascii_isspace(static_cast<unsigned char>(rest[end]))) {
    ++end;
  }
  const absl::string_view word = rest.substr(0, end);
  rest.remove_prefix(std::min(rest.size(), end + 1));
  return word;
}

/// Returns the number in the first four bytes. There MUST be at least four.
std::uint32_t first_number(absl::string_view bytes, bool big_endian) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes.data(), sizeof(bits));
  return big_endian ? __builtin_bswap32(bits) : bits;
}

float float_at(absl::string_view bytes, std::size_t index, bool big_endian) {
  return std::bit_cast<float>(first_number(bytes.substr(index * sizeof(float)), big_endian));
}

bool is_pfm(absl::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         absl::ascii_isspace(static_cast<unsigned char>(bytes[2]));
}

/// Decodes a portable float map (PFM), which renderlib/image writes and stb_image does not support.
/// The file has "PF" for three channels or "Pf" for one, width, height, and a scale whose sign is
/// the byte order. Then the rows follow, from the bottom. A single channel becomes three equal
/// ones. Values may be anything including NaN, because `bandsaw compare` also reads renderings that
/// have such values. Returns INVALID_ARGUMENT if the file is broken or truncated.
absl::StatusOr<Image> decode_pfm(absl::string_view bytes) {
  const std::size_t channels = take_word(bytes) == "PF" ? 3 : 1;
  Image image;
  double scale = 0;
  const bool sizes = absl::SimpleAtoi(take_word(bytes), &image.width) &&
                     absl::SimpleAtoi(take_word(bytes), &image.height);
  if (!sizes || !absl::SimpleAtod(take_word(bytes), &scale) || scale == 0) {
    return absl::InvalidArgumentError("has a broken PFM header");
  }
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (image.width < 1 || image.height < 1 || pixels > kMaxPixels) {
    return absl::InvalidArgumentError(absl::StrCat("is ", image.width, " x ", image.height,
                                                   " pixels, at most ", kMaxPixels, " are read"));
  }
  if (bytes.size() != pixels * channels * sizeof(float)) {
    return absl::InvalidArgumentError(absl::StrCat("has ", bytes.size(),
                                                   " bytes of pixels, but its size needs ",
                                                   pixels * channels * sizeof(float)));
  }
  image.pixels.resize(pixels);
  for (std::size_t y = 0; y < image.height; ++y) {
    for (std::size_t x = 0; x < image.width; ++x) {
      const std::size_t from = ((image.height - 1 - y) * image.width + x) * channels;
      std::array<float, 3> value{};
      for (std::size_t c = 0; c < 3; ++c) {
        value[c] = float_at(bytes, from + (channels == 3 ? c : 0), scale > 0);
      }
      image.pixels[y * image.width + x] = {value[0], value[1], value[2]};
    }
  }
  return image;
}

template <class T>
using Pixels = std::shared_ptr<T>;

/// Returns pixels that stb_image has allocated. stb_image frees them with the last reference.
template <class T>
Pixels<T> owned(T* pixels) {
  return Pixels<T>(pixels, [](T* p) { stbi_image_free(p); });
}

struct Shape {
  int width = 0;
  int height = 0;
  int channels = 0;  ///< of the file: 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha
};

/// Returns an error with the reason for which stb_image could not decode a file.
absl::Status failure() {
  const char* reason = stbi_failure_reason();
  return absl::InvalidArgumentError(
      absl::StrCat("is not an image that can be read, or is damaged (",
                   reason == nullptr ? "unknown reason" : reason, ")"));
}

const stbi_uc* data_of(absl::string_view bytes) {
  return reinterpret_cast<const stbi_uc*>(bytes.data());
}

/// Returns true for a PNG file with a tRNS chunk, which gives texels an alpha. stb_image returns
/// this alpha, but its header function does not count it as a channel.
bool is_png_with_trns(absl::string_view bytes) {
  constexpr absl::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (!absl::ConsumePrefix(&bytes, kSignature)) {
    return false;
  }
  constexpr std::size_t kAround = 12;  // bytes of a chunk's length, type and checksum
  while (bytes.size() >= kAround) {
    const absl::string_view type = bytes.substr(4, 4);
    if (type == "tRNS" || type == "IDAT") {
      return type == "tRNS";
    }
    const std::size_t length = first_number(bytes, /*big_endian=*/true);
    bytes.remove_prefix(std::min(bytes.size(), kAround + length));
  }
  return false;
}

/// Reads the size and the channels from the header of a file that libwebp or stb_image decodes.
/// Returns INVALID_ARGUMENT if the header is broken or a side is too long.
absl::StatusOr<Shape> shape_of(absl::string_view bytes) {
  Shape shape;
  if (is_webp(bytes)) {
    ASSIGN_OR_RETURN(const WebpHeader header, webp_header(bytes));
    shape = {header.width, header.height, header.has_alpha ? 4 : 3};
  } else if (stbi_info_from_memory(data_of(bytes), static_cast<int>(bytes.size()), &shape.width,
                                   &shape.height, &shape.channels) == 0) {
    return failure();
  } else if (shape.channels % 2 == 1 && is_png_with_trns(bytes)) {
    ++shape.channels;
  }
  const int most = static_cast<int>(kMaxTextureSide);
  if (shape.width < 1 || shape.height < 1 || shape.width > most || shape.height > most) {
    return absl::InvalidArgumentError(absl::StrCat(
        "is ", shape.width, " x ", shape.height, " texels, each side must lie in [1, ", most, "]"));
  }
  return shape;
}

// A source that never ends: after the last byte of the file it returns line feeds and records that
// they were read. stb_image 2.27 loops for ever on a Radiance file that ends within a run, and does
// not report that a TGA, BMP or PNM file ends within its pixels. Line feeds end every header line
// and every run.
struct Endless {
  absl::string_view rest;
  /// The buffer in which stb_image keeps bytes that it reads ahead. The first request of stb_image
  /// is for this buffer.
  const char* ahead = nullptr;
  bool overrun = false;
};

// Called by stb_image: writes at most `size` bytes of the source `user` to `to`. Returns their
// number.
int read_endless(void* user, char* to, int size) {
  auto& source = *static_cast<Endless*>(user);
  source.ahead = source.ahead == nullptr ? to : source.ahead;
  const std::size_t wanted = static_cast<std::size_t>(size);
  const std::size_t real = std::min(wanted, source.rest.size());
  std::memcpy(to, source.rest.data(), real);
  source.rest.remove_prefix(real);
  // A request into stb_image's own buffer reads ahead: it may get fewer bytes than it wants, but at
  // least one. Any other request must get all bytes.
  if (real == wanted || (real > 0 && to == source.ahead)) {
    return static_cast<int>(real);
  }
  std::memset(to + real, '\n', wanted - real);
  source.overrun = true;
  return size;
}

// A skip past the end is no overrun, because BMP files may end before the padding of their last
// row.
void skip_endless(void* user, int size) {
  auto& source = *static_cast<Endless*>(user);
  const std::size_t wanted = static_cast<std::size_t>(std::max(size, 0));
  source.rest.remove_prefix(std::min(wanted, source.rest.size()));
}

int at_end(void* user) { return static_cast<const Endless*>(user)->overrun ? 1 : 0; }

constexpr stbi_io_callbacks kEndless{read_endless, skip_endless, at_end};

// Returns the error of a decoding that failed or read past the end of the file.
absl::Status failure(const Endless& source) {
  return source.overrun ? absl::InvalidArgumentError("is truncated: its last pixels are missing")
                        : failure();
}

// Returns true for the formats in which stb_image itself handles a truncated file. It refuses a
// truncated PNG file, and decodes the part of a truncated JPEG file that is present.
bool is_png_or_jpeg(absl::string_view bytes) {
  return absl::StartsWith(bytes, "\x89PNG") || absl::StartsWith(bytes, "\xff\xd8");
}

// Returns true for a binary PNM file with 16 bits for each value. stb_image converts such a file to
// another number of channels as if it had 8 bits, and reads beyond the end of its pixels.
bool is_deep_pnm(absl::string_view bytes) {
  return (absl::StartsWith(bytes, "P5") || absl::StartsWith(bytes, "P6")) &&
         stbi_is_16_bit_from_memory(data_of(bytes), static_cast<int>(bytes.size())) != 0;
}

// Returns an image whose texels stay in the decoder's memory, which is freed with the last
// reference.
template <class T>
ImageTexture texture_of(Pixels<T> pixels, const Shape& shape, int channels,
                        ImageTexture::Format format) {
  ImageTexture image;
  image.width = static_cast<std::uint32_t>(shape.width);
  image.height = static_cast<std::uint32_t>(shape.height);
  image.format = format;
  image.channels = static_cast<std::uint8_t>(channels);
  const auto* bytes = reinterpret_cast<const std::byte*>(pixels.get());
  image.texels = SharedBytes(std::move(pixels), absl::MakeConstSpan(bytes, texel_bytes(image)));
  return image;
}

/// Decodes a Radiance file (HDR) to linear floats.
absl::StatusOr<ImageTexture> decode_radiance(absl::string_view bytes) {
  Endless source{bytes};
  Shape shape;
  Pixels<float> pixels = owned(stbi_loadf_from_callbacks(&kEndless, &source, &shape.width,
                                                         &shape.height, &shape.channels, 3));
  if (source.overrun || pixels == nullptr) {
    return failure(source);
  }
  return texture_of(std::move(pixels), shape, 3, ImageTexture::Format::kFloat32);
}

/// Decodes to pixels of `channels` bytes, and sets the properties of `shape` that the decoder
/// found.
absl::StatusOr<Pixels<stbi_uc>> decode_pixels(absl::string_view bytes, int channels, Shape& shape) {
  if (is_webp(bytes)) {
    ASSIGN_OR_RETURN(shape, shape_of(bytes));
    return decode_webp(bytes, channels);
  }
  if (is_deep_pnm(bytes)) {
    return absl::InvalidArgumentError(
        "is a PNM file with two bytes for each value, which is not supported; save it as PNG");
  }
  Endless source{bytes};
  Pixels<stbi_uc> pixels =
      owned(is_png_or_jpeg(bytes)
                ? stbi_load_from_memory(data_of(bytes), static_cast<int>(bytes.size()),
                                        &shape.width, &shape.height, &shape.channels, channels)
                : stbi_load_from_callbacks(&kEndless, &source, &shape.width, &shape.height,
                                           &shape.channels, channels));
  if (source.overrun || pixels == nullptr) {
    return failure(source);
  }
  return pixels;
}

/// Decodes a file of an 8-bit format to an sRGB texture with `channels` channels.
absl::StatusOr<ImageTexture> decode_bytes(absl::string_view bytes, int channels) {
  Shape shape;
  ASSIGN_OR_RETURN(Pixels<stbi_uc> pixels, decode_pixels(bytes, channels, shape));
  return texture_of(std::move(pixels), shape, channels, ImageTexture::Format::kSrgb8);
}

}  // namespace

absl::StatusOr<ImageTexture> decode_image(absl::string_view bytes,
                                          std::vector<std::string>& warnings, Gray gray) {
  if (bytes.size() >= kMaxImageFileBytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat("has ", bytes.size(), " bytes, at most ", kMaxImageFileBytes, " are read"));
  }
  if (is_exr(bytes)) {
    return decode_exr(bytes);
  }
  ASSIGN_OR_RETURN(const Shape shape, shape_of(bytes));
  const int size = static_cast<int>(bytes.size());
  if (stbi_is_hdr_from_memory(data_of(bytes), size) != 0) {
    return decode_radiance(bytes);
  }
  if (shape.channels == 2 || shape.channels == 4) {
    warnings.emplace_back(kAlphaWarning);
  }
  if (stbi_is_16_bit_from_memory(data_of(bytes), size) != 0) {
    warnings.emplace_back("its 16 bits a channel are read as 8");
  }
  return decode_bytes(bytes, gray == Gray::kKept && shape.channels <= 2 ? 1 : 3);
}

absl::StatusOr<ImageTexture> decode_alpha(absl::string_view bytes) {
  if (bytes.size() >= kMaxImageFileBytes) {
    return absl::ResourceExhaustedError(
        absl::StrCat("has ", bytes.size(), " bytes, at most ", kMaxImageFileBytes, " are read"));
  }
  ASSIGN_OR_RETURN(const Shape shape, shape_of(bytes));
  ImageTexture alpha;
  alpha.width = 1;
  alpha.height = 1;
  std::vector<std::byte> texels{std::byte{255}};
  if (shape.channels == 2 || shape.channels == 4) {
    // A file with only grey and alpha is decoded to four channels too, so alpha is always the last
    // of four.
    Shape found;
    ASSIGN_OR_RETURN(const Pixels<stbi_uc> pixels, decode_pixels(bytes, 4, found));
    alpha.width = static_cast<std::uint32_t>(found.width);
    alpha.height = static_cast<std::uint32_t>(found.height);
    texels.resize(std::size_t{alpha.width} * alpha.height);
    for (std::size_t i = 0; i < texels.size(); ++i) {
      texels[i] = std::byte{pixels.get()[4 * i + 3]};
    }
  }
  alpha.format = ImageTexture::Format::kLinear8;
  alpha.channels = 1;
  alpha.texels = std::move(texels);
  return alpha;
}

bool image_has_alpha(absl::string_view bytes) {
  const auto shape = bytes.size() < kMaxImageFileBytes && !is_exr(bytes)
                         ? shape_of(bytes)
                         : absl::InvalidArgumentError("");
  return shape.ok() && (shape->channels == 2 || shape->channels == 4);
}

absl::StatusOr<Image> decode_picture(absl::string_view bytes) {
  if (is_pfm(bytes)) {
    return decode_pfm(bytes);
  }
  std::vector<std::string> unused;
  ASSIGN_OR_RETURN(const ImageTexture texels, decode_image(bytes, unused));
  Image image{texels.width, texels.height, {}};
  image.pixels.resize(std::size_t{image.width} * image.height);
  if (texels.format == ImageTexture::Format::kFloat32) {
    std::memcpy(image.pixels.data(), texels.texels.data(), texels.texels.size());
    return image;
  }
  const auto linear = [&](std::size_t i) {
    return srgb_table()[static_cast<std::size_t>(texels.texels[i])];
  };
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = {linear(3 * i), linear(3 * i + 1), linear(3 * i + 2)};
  }
  return image;
}

}  // namespace bandsaw
