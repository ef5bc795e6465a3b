// Converts each row to four bytes a pixel and writes each of the four channels run-length coded.

#include "renderlib/image/hdr.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

/// Above this value the shared exponent would overflow.
constexpr float kMax = 0x1.fep126f;

/// Returns the nearest value in [0, kMax]; 0 for NaN.
float repaired(float v) { return v > 0 ? std::min(v, kMax) : 0; }

/// Returns the mantissas of red, green and blue, and the exponent of the largest channel plus 128
/// (Ward 1991). Pixels whose channels are all below 2^-127 become 0.
Rgbe rgbe(const Rgb& pixel) {
  const Rgb p = {repaired(pixel.r), repaired(pixel.g), repaired(pixel.b)};
  const float largest = max_component(p);
  if (largest < 0x1p-127f) {
    return {};
  }
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  if (std::floor(std::ldexp(largest, 8 - exponent) + 0.5f) > 255) {
    ++exponent;  // Rounding reaches the next power of two.
  }
  const auto mantissa = [&](float v) {
    return static_cast<std::uint8_t>(std::floor(std::ldexp(v, 8 - exponent) + 0.5f));
  };
  return {mantissa(p.r), mantissa(p.g), mantissa(p.b), static_cast<std::uint8_t>(exponent + 128)};
}

/// Writes the run-length coded rows.
class RowWriter {
 public:
  explicit RowWriter(std::vector<std::byte>& out) : out_(out) {}

  /// Appends one byte.
  void put(std::size_t value) { out_.push_back(static_cast<std::byte>(value)); }

  /// Writes one channel of a row: runs of three and more as (128 + length, value), other values as
  /// (length, values).
  void channel(const std::vector<Rgbe>& row, std::size_t c) {
    std::size_t plain = 0;  // start of the values not yet written
    for (std::size_t at = 0; at < row.size();) {
      std::size_t run = 1;
      while (run < 127 && at + run < row.size() && row[at + run][c] == row[at][c]) {
        ++run;
      }
      if (run >= 3) {
        literal(row, c, plain, at);
        put(128 + run);
        put(row[at][c]);
        plain = at + run;
      }
      at += run;
    }
    literal(row, c, plain, row.size());
  }

 private:
  /// Writes values [from, to) of channel c without runs, as (length, values).
  void literal(const std::vector<Rgbe>& row, std::size_t c, std::size_t from, std::size_t to) {
    while (from < to) {
      const std::size_t count = std::min<std::size_t>(to - from, 128);
      put(count);
      for (std::size_t i = 0; i < count; ++i) {
        put(row[from + i][c]);
      }
      from += count;
    }
  }

  std::vector<std::byte>& out_;
};

}  // namespace

std::vector<std::byte> encode_hdr(const Image& image) {
  const std::string header = absl::StrCat("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ", image.height,
                                          " +X ", image.width, "\n");
  std::vector<std::byte> out;
  for (const char c : header) {
    out.push_back(static_cast<std::byte>(c));
  }
  RowWriter writer(out);
  // Readers expect runs only in rows of 8 to 32,767 pixels. Other rows are written without runs, in
  // the older form of the format.
  const bool runs = image.width >= 8 && image.width < 32768;
  std::vector<Rgbe> row(image.width);
  for (std::uint32_t y = 0; y < image.height; ++y) {
    for (std::uint32_t x = 0; x < image.width; ++x) {
      row[x] = rgbe(image.at(x, y));
    }
    if (runs) {
      // A row begins with 2, 2 and the width.
      for (const std::size_t byte :
           {std::size_t{2}, std::size_t{2}, row.size() >> 8, row.size() & 255}) {
        writer.put(byte);
      }
      for (std::size_t c = 0; c < 4; ++c) {
        writer.channel(row, c);
      }
      continue;
    }
    for (const Rgbe& pixel : row) {
      for (const std::uint8_t byte : pixel) {
        writer.put(byte);
      }
    }
  }
  return out;
}

}  // namespace bandsaw
