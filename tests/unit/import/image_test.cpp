// Image files that are read: textures, environments, and images that Bandsaw wrote.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "renderlib/image/write_image.h"
#include "renderlib/import/image/decode_image.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

std::string text_of(const std::vector<std::byte>& bytes) {
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

Image ramp(std::uint32_t width, std::uint32_t height) {
  Image image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const auto v = static_cast<float>(i);
    image.pixels.push_back({v / 64, v / 128, 0.5f});
  }
  return image;
}

// Returns a Radiance file of the colour (2, 1, 0.5), each row run-length encoded.
std::string radiance(std::uint32_t width, std::uint32_t height) {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                     std::to_string(width) + "\n";
  for (std::uint32_t y = 0; y < height; ++y) {
    file += std::string("\x02\x02", 2) + static_cast<char>(width >> 8) + static_cast<char>(width);
    for (const char value : {'\x80', '\x40', '\x20', '\x82'}) {
      for (std::uint32_t left = width; left > 0;) {
        const std::uint32_t run = std::min(left, 127u);
        file += static_cast<char>(128 + run);
        file += value;
        left -= run;
      }
    }
  }
  return file;
}

TEST(DecodeImage, KeepsEightBitTexels) {
  std::vector<std::string> warnings;
  const auto image = decode_image(test::small_ppm(), warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->format, ImageTexture::Format::kSrgb8);
  ASSERT_EQ(image->texels.size(), 12u);
  EXPECT_EQ(image->texels[0], std::byte{255});
  EXPECT_EQ(image->texels[4], std::byte{255});
  EXPECT_EQ(image->texels[8], std::byte{255});
  EXPECT_THAT(warnings, ::testing::IsEmpty());
}

TEST(DecodeImage, ExpandsGreyToThreeChannels) {
  std::vector<std::string> warnings;
  const auto image = decode_image(std::string("P5 2 1 255\n") + "\x10\x20", warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->texels, (std::vector<std::byte>{std::byte{16}, std::byte{16}, std::byte{16},
                                                   std::byte{32}, std::byte{32}, std::byte{32}}));
}

TEST(DecodeImage, ReadsRadianceAsLinearFloats) {
  std::vector<std::string> warnings;
  const auto image = decode_image(radiance(200, 3), warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->format, ImageTexture::Format::kFloat32);
  EXPECT_EQ(image->width, 200u);
  float texel[3];
  std::memcpy(texel, image->texels.data() + (200 * 3 - 1) * sizeof(texel), sizeof(texel));
  EXPECT_EQ(texel[0], 2.0f);
  EXPECT_EQ(texel[1], 1.0f);
  EXPECT_EQ(texel[2], 0.5f);
}

// Without further checks, the decoder stb_image does not terminate for some of these files.
TEST(DecodeImage, ATruncatedRadianceFileIsAnError) {
  const std::string whole = radiance(64, 8);
  std::vector<std::string> warnings;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(decode_image(whole.substr(0, size), warnings).ok()) << size;
  }
  EXPECT_TRUE(decode_image(whole, warnings).ok());
  EXPECT_THAT(
      std::string(decode_image(whole.substr(0, whole.size() - 2), warnings).status().message()),
      HasSubstr("truncated"));
}

// Returns a TGA file of 3 x 50 pixels. `type`: 2 without compression, 10 with runs; `pixels`: the
// bytes after the header.
std::string tga(char type, const std::string& pixels) {
  const char header[18] = {0, 0, type, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 50, 0, 24, 0};
  return std::string(header, sizeof header) + pixels;
}

// Returns a BMP file of 3 x 50 pixels. Each row has 9 bytes of pixels and 3 bytes of padding.
std::string bmp() {
  const char header[54] = {'B', 'M', 0, 0, 0, 0, 0, 0,  0, 0, 54, 0, 0, 0,  40,
                           0,   0,   0, 3, 0, 0, 0, 50, 0, 0, 0,  1, 0, 24, 0};
  return std::string(header, sizeof header) + std::string(50 * 12, '\x50');
}

TEST(DecodeImage, APnmFileOf16BitsIsAnError) {
  std::vector<std::string> warnings;
  for (const std::string& whole : {std::string("P6 3 50 65535\n") + std::string(900, '\x50'),
                                   std::string("P5 3 50 65535\n") + std::string(300, '\x50')}) {
    EXPECT_THAT(std::string(decode_image(whole, warnings).status().message()),
                HasSubstr("save it as PNG"));
  }
}

// Without further checks, the decoder stb_image leaves the missing pixels of such files
// uninitialized. If the header is cut, the decoder does not terminate. The last three bytes of the
// BMP file are padding and may be missing, so all tested files lack at least four bytes.
TEST(DecodeImage, AFileWithoutItsLastPixelsIsAnError) {
  std::string runs;
  for (int i = 0; i < 50; ++i) {
    runs += std::string("\x82\x10\x20\x30", 4);
  }
  std::vector<std::string> warnings;
  for (const std::string& whole : {std::string("P6 3 50 255\n") + std::string(450, '\x50'),
                                   std::string("P5 3 50 255\n") + std::string(150, '\x50'),
                                   tga(2, std::string(450, '\x50')), tga(10, runs), bmp()}) {
    EXPECT_TRUE(decode_image(whole, warnings).ok()) << whole.substr(0, 2);
    for (std::size_t size = 0; size < whole.size() - 3; ++size) {
      EXPECT_FALSE(decode_image(whole.substr(0, size), warnings).ok()) << size;
    }
    EXPECT_THAT(
        std::string(decode_image(whole.substr(0, whole.size() - 4), warnings).status().message()),
        HasSubstr("truncated"));
  }
  const std::string whole = bmp();
  EXPECT_TRUE(decode_image(whole.substr(0, whole.size() - 3), warnings).ok())
      << "the padding of the last row may be missing";
}

TEST(DecodeImage, ChangedBytesDoNotCrash) {
  std::mt19937_64 random(3);
  std::vector<std::string> warnings;
  const std::vector<std::string> files = {
      radiance(64, 8), test::small_ppm(),
      text_of(encode_image(ramp(16, 8), ImageFormat::kPng).value()),
      text_of(encode_image(ramp(16, 8), ImageFormat::kPfm).value())};
  for (const std::string& file : files) {
    for (int round = 0; round < 2000; ++round) {
      std::string changed = file;
      for (int i = 0; i < 3; ++i) {
        changed[random() % changed.size()] = static_cast<char>(random());
      }
      changed.resize(changed.size() - random() % 8);
      (void)decode_image(changed, warnings);
      (void)decode_picture(changed);
    }
  }
}

TEST(DecodeImage, ChecksTheSizeBeforeItDecodes) {
  std::vector<std::string> warnings;
  const auto image = decode_image("P6 100000 70000 255\n", warnings);
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("100000 x 70000"));
}

TEST(DecodePicture, GivesBackAPfmBitForBit) {
  Image image = ramp(7, 5);
  image.pixels[3] = {-1, std::nanf(""), 1e30f};
  const std::string file = text_of(encode_image(image, ImageFormat::kPfm).value());
  const auto read = decode_picture(file);
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->pixels.size(), image.pixels.size());
  EXPECT_EQ(std::memcmp(read->pixels.data(), image.pixels.data(), 35 * sizeof(Rgb)), 0);
  EXPECT_FALSE(decode_picture(file.substr(0, file.size() - 1)).ok());
  EXPECT_FALSE(decode_picture(file + "x").ok());
  EXPECT_FALSE(decode_picture("PF\n4294967295 4294967295\n-1\n").ok());
}

TEST(DecodePicture, GivesBackAPngToHalfAStepOfEightBits) {
  const Image image = ramp(8, 8);
  const auto read = decode_picture(text_of(encode_image(image, ImageFormat::kPng).value()));
  ASSERT_TRUE(read.ok()) << read.status();
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    EXPECT_NEAR(read->pixels[i].r, std::min(image.pixels[i].r, 1.0f), 0.005);
  }
}

/// Returns an image with values of many magnitudes, zeros, and long and short runs of equal pixels.
Image varied(std::uint32_t width, std::uint32_t height) {
  Image image{width, height, {}};
  std::mt19937_64 random(17);
  while (image.pixels.size() < std::size_t{width} * height) {
    const auto number = [&] {
      const auto mantissa = static_cast<float>(random() % 1000) / 1000;
      return std::ldexp(mantissa, static_cast<int>(random() % 40) - 20);
    };
    const Rgb pixel{number(), number(), number()};
    const std::size_t run = random() % 3 == 0 ? random() % 300 : 1;
    for (std::size_t i = 0; i <= run && image.pixels.size() < std::size_t{width} * height; ++i) {
      image.pixels.push_back(random() % 50 == 0 ? Rgb{} : pixel);
    }
  }
  return image;
}

TEST(DecodePicture, GivesBackAnHdrToHalfAUnitOfTheMantissa) {
  for (const auto& [width, height] : {std::pair(3u, 5u), {8u, 4u}, {300u, 7u}}) {
    const Image image = varied(width, height);
    const auto read = decode_picture(text_of(encode_image(image, ImageFormat::kHdr).value()));
    ASSERT_TRUE(read.ok()) << read.status();
    ASSERT_EQ(read->pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      // The channels of a pixel share an exponent. The largest mantissa is at least 128, so half a
      // unit of a mantissa is at most 1/256 of the largest channel.
      const float bound = max_component(image.pixels[i]) / 255.0f;
      EXPECT_NEAR(read->pixels[i].r, image.pixels[i].r, bound) << i;
      EXPECT_NEAR(read->pixels[i].g, image.pixels[i].g, bound) << i;
      EXPECT_NEAR(read->pixels[i].b, image.pixels[i].b, bound) << i;
    }
  }
}

// Negative values and NaN become 0. Infinity becomes the largest value, which is 1.7e38.
TEST(DecodePicture, HdrRoundsToTheNearestRepresentableValue) {
  const float inf = std::numeric_limits<float>::infinity();
  const Image image{4, 1, {{-1, std::nanf(""), 0}, {inf, 1, 0}, {255.9f, 0, 0}, {1, 0.5f, 0.25f}}};
  const auto read = decode_picture(text_of(encode_image(image, ImageFormat::kHdr).value()));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pixels[0], Rgb{});
  EXPECT_GT(read->pixels[1].r, 1.6e38f);
  EXPECT_EQ(read->pixels[2], (Rgb{256, 0, 0}));
  EXPECT_EQ(read->pixels[3], image.pixels[3]);
}

TEST(DecodePicture, GivesBackAnExrOfFloatsBitForBit) {
  Image image = varied(37, 21);
  image.pixels[3] = {-1, std::nanf(""), 1e30f};
  const auto read = decode_picture(text_of(encode_image(image, ImageFormat::kExr).value()));
  ASSERT_TRUE(read.ok()) << read.status();
  ASSERT_EQ(read->width, 37u);
  ASSERT_EQ(read->height, 21u);
  EXPECT_EQ(std::memcmp(read->pixels.data(), image.pixels.data(), 37 * 21 * sizeof(Rgb)), 0);
}

TEST(DecodePicture, GivesBackAnExrOfHalvesToElevenBits) {
  Image image = ramp(16, 9);
  image.pixels[5] = {1e9f, -1e9f, 65504};
  const auto file = encode_image(image, ImageFormat::kExr, {.half = true}).value();
  EXPECT_LT(file.size(), encode_image(image, ImageFormat::kExr).value().size());
  const auto read = decode_picture(text_of(file));
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->pixels[5], (Rgb{65504, -65504, 65504}));
  for (std::size_t i = 6; i < image.pixels.size(); ++i) {
    EXPECT_NEAR(read->pixels[i].r, image.pixels[i].r, image.pixels[i].r / 1024);
    EXPECT_NEAR(read->pixels[i].g, image.pixels[i].g, image.pixels[i].g / 1024);
  }
}

TEST(DecodePicture, AnExrIsReadAsATexture) {
  std::vector<std::string> warnings;
  const Image image = varied(5, 4);
  const auto read = decode_image(text_of(encode_image(image, ImageFormat::kExr).value()), warnings);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(read->format, ImageTexture::Format::kFloat32);
  EXPECT_EQ(std::memcmp(read->texels.data(), image.pixels.data(), read->texels.size()), 0);
}

TEST(DecodePicture, ABrokenExrIsAnError) {
  const std::string file = text_of(encode_image(varied(37, 21), ImageFormat::kExr).value());
  for (const std::size_t size : {std::size_t{4}, std::size_t{9}, std::size_t{100}}) {
    EXPECT_THAT(std::string(decode_picture(file.substr(0, size)).status().message()),
                HasSubstr("damaged"))
        << size;
  }
}

}  // namespace
}  // namespace bandsaw
