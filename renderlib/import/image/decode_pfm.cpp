#include "renderlib/import/image/decode_pfm.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "renderlib/render/settings.h"

namespace bandsaw {
namespace {

// The next word of the header and the one white space after it.
absl::string_view take_word(absl::string_view& rest) {
  std::size_t end = 0;
  while (end < rest.size() && !absl::ascii_isspace(static_cast<unsigned char>(rest[end]))) {
    ++end;
  }
  const absl::string_view word = rest.substr(0, end);
  rest.remove_prefix(std::min(rest.size(), end + 1));
  return word;
}

float float_at(absl::string_view bytes, std::size_t index, bool big_endian) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, bytes.data() + index * sizeof(bits), sizeof(bits));
  return std::bit_cast<float>(big_endian ? __builtin_bswap32(bits) : bits);
}

}  // namespace

bool is_pfm(absl::string_view bytes) {
  return bytes.size() > 2 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         absl::ascii_isspace(static_cast<unsigned char>(bytes[2]));
}

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
    return absl::InvalidArgumentError(absl::StrCat("has ", bytes.size(), " bytes of pixels, ",
                                                   pixels * channels * sizeof(float),
                                                   " belong to its size"));
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

}  // namespace bandsaw
