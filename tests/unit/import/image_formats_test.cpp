// The decoding of one tiny file of each image format, written according to its specification.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "renderlib/import/image/decode_image.h"

namespace bandsaw {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string bytes(std::initializer_list<int> values) {
  std::string out;
  for (const int value : values) {
    out += static_cast<char>(value);
  }
  return out;
}

/// Returns the values of all channels of all texels, which have 8 bits.
std::vector<int> codes(const ImageTexture& image) {
  std::vector<int> out;
  for (const std::byte b : image.texels) {
    out.push_back(static_cast<int>(b));
  }
  return out;
}

/// Decodes the bytes of a file, and expects no error and no warning.
ImageTexture decoded(const std::string& file, Gray gray = Gray::kKept) {
  std::vector<std::string> warnings;
  auto image = decode_image(file, warnings, gray);
  EXPECT_TRUE(image.ok()) << image.status();
  EXPECT_THAT(warnings, IsEmpty());
  return image.ok() ? *std::move(image) : ImageTexture();
}

// The colour pictures are 2 x 2: red and green above blue and white. Red has the code 250, so that
// it cannot be mistaken for the 255 of the other colours.
constexpr int kRed = 250;

TEST(ImageFormats, PpmGoesFromTheTopRowDown) {
  const ImageTexture image = decoded("P6\n# a comment\n2 2\n255\n" +
                                     bytes({kRed, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}));
  EXPECT_THAT(codes(image), ElementsAre(kRed, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255));
  EXPECT_EQ(image.format, ImageTexture::Format::kSrgb8);
}

TEST(ImageFormats, PgmIsGrey) {
  const ImageTexture image = decoded("P5 2 1 255\n" + bytes({7, 200}));
  EXPECT_EQ(image.channels, 1);
  EXPECT_THAT(codes(image), ElementsAre(7, 200));
}

// A Truevision TGA 2.0 file of type 2 has its rows from the bottom up. Each pixel begins with blue.
TEST(ImageFormats, TgaGoesFromTheBottomRowUp) {
  const ImageTexture image =
      decoded(bytes({0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 24, 0}) +
              bytes({255, 0, 0, 255, 255, 255, 0, 0, kRed, 0, 255, 0}));
  EXPECT_THAT(codes(image), ElementsAre(kRed, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255));
}

TEST(ImageFormats, ATgaMayBeRunLengthEncodedAndBeginAtTheTop) {
  const ImageTexture image =
      decoded(bytes({0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 1, 0, 24, 0x20}) +
              bytes({0x81, 1, 2, 3, 0x00, 4, 5, 6}));
  EXPECT_THAT(codes(image), ElementsAre(3, 2, 1, 3, 2, 1, 6, 5, 4));
}

// The BMP file has a BITMAPINFOHEADER and 24 bits per pixel. The rows go from the bottom up, and
// each row is padded to a multiple of four bytes.
TEST(ImageFormats, BmpRowsArePaddedToFourBytes) {
  const std::string header = "BM" + bytes({70, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0}) +
                             bytes({40, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 0, 24, 0}) +
                             std::string(24, '\0');
  const ImageTexture image = decoded(header + bytes({255, 0, 0, 255, 255, 255, 0, 0}) +
                                     bytes({0, 0, kRed, 0, 255, 0, 0, 0}));
  EXPECT_THAT(codes(image), ElementsAre(kRed, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255));
}

// A pixel of a Radiance file has a mantissa m for each channel and one exponent e for all channels.
// The value of a channel is (m / 256) 2^(e - 128).
TEST(ImageFormats, AnHdrValueIsAMantissaTimesAPowerOfTwo) {
  const ImageTexture image = decoded("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                                     bytes({128, 64, 0, 131, 255, 128, 1, 120}));
  EXPECT_EQ(image.format, ImageTexture::Format::kFloat32);
  std::vector<float> values(6);
  ASSERT_EQ(image.texels.size(), 24u);
  std::memcpy(values.data(), image.texels.data(), 24);
  EXPECT_THAT(values, ElementsAre(4, 2, 0, 255.0f / 65536, 128.0f / 65536, 1.0f / 65536));
}

// The functions below make files of OpenEXR 2. Numbers have 32 bits, the least significant byte
// first. After the magic number come attributes, each with a name, a type, a size and a value. They
// are followed by the offset of each row or tile in the file (64 bits), and by the rows or tiles.

/// Returns the bytes of a number.
std::string word(std::int32_t value) {
  return bytes({value & 0xff, value >> 8 & 0xff, value >> 16 & 0xff, value >> 24 & 0xff});
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + word(static_cast<std::int32_t>(value.size())) + value;
}

/// Left, top, right and bottom pixel, all inclusive.
using Window = std::array<int, 4>;

std::string box(const Window& window) {
  return word(window[0]) + word(window[1]) + word(window[2]) + word(window[3]);
}

/// Returns an EXR file of one channel of floats, without compression. `tiled`: the chunks are
/// tiles, otherwise rows. `order`: 0 if the file has the chunks from the top, 1 if from the bottom.
/// `stored`, `shown`: the data window and the display window. `chunks`: the rows or tiles from the
/// top, each with its coordinates and its size. `more`: further attributes.
std::string exr(bool tiled, char order, const Window& stored, const Window& shown,
                std::vector<std::string> chunks, const std::string& more = "") {
  const std::string channel = std::string("Y") + '\0' + word(2) + word(0) + word(1) + word(1);
  const std::string header = bytes({0x76, 0x2f, 0x31, 0x01, 2, tiled ? 2 : 0, 0, 0}) +
                             attribute("channels", "chlist", channel + '\0') +
                             attribute("compression", "compression", bytes({0})) +
                             attribute("dataWindow", "box2i", box(stored)) +
                             attribute("displayWindow", "box2i", box(shown)) +
                             attribute("lineOrder", "lineOrder", std::string(1, order)) +
                             attribute("pixelAspectRatio", "float", word(0x3f800000)) +
                             attribute("screenWindowCenter", "v2f", word(0) + word(0)) +
                             attribute("screenWindowWidth", "float", word(0x3f800000)) + more +
                             '\0';
  std::vector<std::string> places(chunks.size());
  std::string body;
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    const std::size_t chunk = order == 0 ? i : chunks.size() - 1 - i;
    const std::size_t at = header.size() + 8 * chunks.size() + body.size();
    places[chunk] = word(static_cast<std::int32_t>(at)) + word(0);
    body += chunks[chunk];
  }
  std::string file = header;
  for (const std::string& place : places) {
    file += place;
  }
  return file + body;
}

/// Returns the size of the values in bytes, and the values.
std::string floats(const std::vector<float>& values) {
  std::string out(values.size() * sizeof(float), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return word(static_cast<std::int32_t>(out.size())) + out;
}

/// Returns the first of the three channels of each texel.
std::vector<float> reds(const ImageTexture& image) {
  std::vector<float> all(image.texels.size() / sizeof(float));
  std::memcpy(all.data(), image.texels.data(), image.texels.size());
  std::vector<float> out;
  for (std::size_t i = 0; i < all.size(); i += 3) {
    out.push_back(all[i]);
  }
  return out;
}

TEST(ImageFormats, ExrRowsMayBeStoredFromTheBottom) {
  const std::vector<std::string> rows{word(0) + floats({1, 2}), word(1) + floats({3, 4}),
                                      word(2) + floats({5, 6})};
  for (const char order : {0, 1}) {
    const ImageTexture image = decoded(exr(false, order, {0, 0, 1, 2}, {0, 0, 1, 2}, rows));
    EXPECT_THAT(reds(image), ElementsAre(1, 2, 3, 4, 5, 6)) << int{order};
  }
}

// The image has 2 x 3 texels in two tiles. A tile has 2 x 2 texels; the lower tile is cut to a row.
TEST(ImageFormats, ExrTilesMayBeStoredFromTheBottom) {
  const std::string tiles =
      attribute("tiles", "tiledesc", word(2) + word(2) + std::string(1, '\0'));
  const std::vector<std::string> chunks{
      word(0) + word(0) + word(0) + word(0) + floats({1, 2, 3, 4}),
      word(0) + word(1) + word(0) + word(0) + floats({5, 6})};
  for (const char order : {0, 1}) {
    const ImageTexture image = decoded(exr(true, order, {0, 0, 1, 2}, {0, 0, 1, 2}, chunks, tiles));
    EXPECT_THAT(reds(image), ElementsAre(1, 2, 3, 4, 5, 6)) << int{order};
  }
}

// Texels of the display window that are outside of the data window are 0. Texels of the data window
// that are outside of the display window are left out.
TEST(ImageFormats, AnExrImageHasTheSizeOfItsDisplayWindow) {
  const std::vector<std::string> rows{word(-1) + floats({1, 2}), word(0) + floats({3, 4})};
  const Window stored{1, -1, 2, 0};
  const ImageTexture larger = decoded(exr(false, 0, stored, {0, -1, 2, 1}, rows));
  EXPECT_EQ(larger.width, 3u);
  EXPECT_THAT(reds(larger), ElementsAre(0, 1, 2, 0, 3, 4, 0, 0, 0));
  const ImageTexture smaller = decoded(exr(false, 1, stored, {2, 0, 3, 0}, rows));
  EXPECT_EQ(smaller.height, 1u);
  EXPECT_THAT(reds(smaller), ElementsAre(4, 0));
  std::vector<std::string> warnings;
  const auto huge = decode_image(exr(false, 0, stored, {0, 0, 99999, 99999}, rows), warnings);
  EXPECT_THAT(std::string(huge.status().message()), HasSubstr("is 100000 x 100000 pixels"));
}

TEST(ImageFormats, AlphaOfATgaIsRead) {
  const std::string file = bytes({0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28}) +
                           bytes({1, 2, 3, 40, 5, 6, 7, 80});
  EXPECT_TRUE(image_has_alpha(file));
  EXPECT_THAT(codes(decode_alpha(file).value()), ElementsAre(40, 80));
  EXPECT_FALSE(image_has_alpha("P5 1 1 255\n7"));
}

// The chunk tRNS of a PNG file names the one colour whose alpha is 0. The pixels are an
// uncompressed block of zlib. The last four bytes of each chunk are the checksum of the chunk.
TEST(ImageFormats, APngMayNameOneTransparentColour) {
  const std::string signature = "\x89PNG\r\n\x1a\n";
  const std::string end = bytes({0, 0, 0, 0}) + "IEND" + bytes({0xae, 0x42, 0x60, 0x82});
  const std::string rgb_header = signature + bytes({0, 0, 0, 13}) + "IHDR" +
                                 bytes({0, 0, 0, 2, 0, 0, 0, 1, 8, 2, 0, 0, 0}) +
                                 bytes({0x7b, 0x40, 0xe8, 0xdd});
  const std::string green_is_clear =
      bytes({0, 0, 0, 6}) + "tRNS" + bytes({0, 0, 0, 255, 0, 0, 0xd0, 0x3e, 0x33, 0x7c});
  const std::string rgb_pixels = bytes({0, 0, 0, 18}) + "IDAT" +
                                 bytes({0x78, 0x01, 0x01, 0x07, 0x00, 0xf8, 0xff, 0, kRed, 0, 0, 0,
                                        255, 0, 0x07, 0xe1, 0x01, 0xfa}) +
                                 bytes({0x45, 0xf5, 0x53, 0xdb}) + end;
  const std::string rgb = rgb_header + green_is_clear + rgb_pixels;
  EXPECT_TRUE(image_has_alpha(rgb));
  EXPECT_THAT(codes(decode_alpha(rgb).value()), ElementsAre(255, 0));
  EXPECT_FALSE(image_has_alpha(rgb_header + rgb_pixels));
  EXPECT_THAT(codes(decoded(rgb_header + rgb_pixels)), ElementsAre(kRed, 0, 0, 0, 255, 0));
  const std::string grey =
      signature + bytes({0, 0, 0, 13}) + "IHDR" +
      bytes({0, 0, 0, 2, 0, 0, 0, 1, 8, 0, 0, 0, 0, 0xd1, 0x49, 0x20, 0x56}) + bytes({0, 0, 0, 2}) +
      "tRNS" + bytes({0, 200, 0xe3, 0x2c, 0x87, 0xba}) + bytes({0, 0, 0, 14}) + "IDAT" +
      bytes({0x78, 0x01, 0x01, 0x03, 0x00, 0xfc, 0xff, 0, 7, 200, 0x00, 0xd9, 0x00, 0xd0}) +
      bytes({0x1f, 0xad, 0x24, 0xf8}) + end;
  EXPECT_TRUE(image_has_alpha(grey));
  EXPECT_THAT(codes(decode_alpha(grey).value()), ElementsAre(255, 0));
  EXPECT_FALSE(image_has_alpha(rgb_header)) << "a file that ends after its header has no alpha";
}

}  // namespace
}  // namespace bandsaw
