// Image files: the sRGB encoding and the bytes of PFM, PPM and PNG. An id such as TX5 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/image/write_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "renderlib/image/srgb.h"
#include "tests/support/hard_case.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

Image two_by_two() {
  return {.width = 2,
          .height = 2,
          .pixels = {{0, 0.5f, 1}, {2, -1, 0.1f}, {1e-30f, 3e38f, -0.0f}, {0.2f, 0.3f, 0.4f}}};
}

std::string text(const std::vector<std::byte>& bytes) {
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string encoded(const Image& image, ImageFormat format) {
  const auto bytes = encode_image(image, format);
  EXPECT_TRUE(bytes.ok()) << bytes.status();
  return text(*bytes);
}

/// Returns the bytes of a file.
std::string file(const std::string& path) {
  std::ostringstream out;
  out << std::ifstream(path, std::ios::binary).rdbuf();
  return out.str();
}

TEST(Srgb, TX5EveryCodeSurvivesDecodingAndEncoding) {
  for (int code = 0; code < 256; ++code) {
    EXPECT_EQ(srgb_encode(srgb_table()[static_cast<std::size_t>(code)]), code);
  }
  test::report_hard_case("TX5", "256 of 256 codes unchanged by decoding and encoding");
}

TEST(Srgb, TheTableIsTheStandardsCurve) {
  EXPECT_EQ(srgb_table()[0], 0.0f);
  EXPECT_EQ(srgb_table()[255], 1.0f);
  EXPECT_NEAR(srgb_table()[10], 10 / 255.0 / 12.92, 1e-9);
  EXPECT_NEAR(srgb_table()[128], 0.21586050011389926, 1e-8);
  EXPECT_NEAR(srgb_table()[11], std::pow((11 / 255.0 + 0.055) / 1.055, 2.4), 1e-9);
}

TEST(Srgb, P1_ValuesOutOfRangeAreClamped) {
  EXPECT_EQ(srgb_encode(-1), 0);
  EXPECT_EQ(srgb_encode(std::nanf("")), 0);
  EXPECT_EQ(srgb_encode(1.0001f), 255);
  EXPECT_EQ(srgb_encode(std::numeric_limits<float>::infinity()), 255);
  test::report_hard_case("P1", "NaN and negative values become code 0, infinity becomes 255");
}

TEST(WriteImage, PfmHoldsTheExactFloatsFromTheBottomRowUp) {
  const Image image = two_by_two();
  const std::string bytes = encoded(image, ImageFormat::kPfm);
  const std::string header = "PF\n2 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), header.size() + 48);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size(), &image.pixels[2], 24), 0);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size() + 24, &image.pixels[0], 24), 0);
}

TEST(WriteImage, P2_PpmHoldsRoundedSrgbCodesFromTheTopRowDown) {
  const std::string bytes = encoded(two_by_two(), ImageFormat::kPpm);
  const std::string header = "P6\n2 2\n255\n";
  ASSERT_EQ(bytes.size(), header.size() + 12);
  // Values out of range are clamped: -1 becomes 0, and 2 and 3e38 become 255.
  const unsigned char expected[] = {0, 188, 255, 255, 0, 89, 0, 255, 0, 124, 149, 170};
  EXPECT_EQ(std::memcmp(bytes.data() + header.size(), expected, 12), 0);
  test::report_hard_case("P2", "PPM codes are rounded to the nearest");
}

TEST(WriteImage, PngHasItsSignatureAndSize) {
  const std::string bytes = encoded(two_by_two(), ImageFormat::kPng);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  // Width, height, 8 bits per channel, and the colour type 2, which is RGB.
  EXPECT_EQ(bytes.substr(16, 10), std::string("\0\0\0\2\0\0\0\2\x08\x02", 10));
  EXPECT_THAT(bytes, HasSubstr("IEND"));
}

TEST(WriteImage, ImagesWithTheWrongNumberOfPixelsAreRefused) {
  Image image = two_by_two();
  image.pixels.pop_back();
  EXPECT_EQ(encode_image(image, ImageFormat::kPng).status().code(),
            absl::StatusCode::kInvalidArgument);
  EXPECT_FALSE(encode_image({}, ImageFormat::kPfm).ok());
}

TEST(WriteImage, TheSuffixDecidesTheFormatInAnyCase) {
  EXPECT_EQ(*image_format_of("a.PNG"), ImageFormat::kPng);
  EXPECT_EQ(*image_format_of("x/b.pfm.Ppm"), ImageFormat::kPpm);
  EXPECT_EQ(*image_format_of(".pfm"), ImageFormat::kPfm);
  for (const char* path : {"a.jpg", "a", "", "png"}) {
    const absl::Status status = image_format_of(path).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), HasSubstr(".png, .ppm, .pfm, .hdr or .exr"));
  }
}

TEST(WriteImage, FilesContainTheEncodedBytesAndReplaceOlderFiles) {
  const test::TempDir folder;
  const std::string path = folder / "a.pfm";
  std::ofstream(path) << "old";
  ASSERT_TRUE(write_image(two_by_two(), path).ok());
  EXPECT_EQ(file(path), encoded(two_by_two(), ImageFormat::kPfm));
}

TEST(WriteImage, UnwritableFilesAreDetectedBeforehand) {
  const test::TempDir folder;
  EXPECT_TRUE(check_writable(folder / "a.png").ok());
  EXPECT_TRUE(check_writable("a.png").ok());
  EXPECT_EQ(check_writable(folder / "a.gif").code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(check_writable(folder / "none/a.png").code(), absl::StatusCode::kNotFound);
  std::filesystem::create_directory(folder / "dir.png");
  EXPECT_FALSE(check_writable(folder / "dir.png").ok());
  std::ofstream(folder / "file") << "x";
  EXPECT_FALSE(check_writable(folder / "file/a.png").ok());
  EXPECT_FALSE(write_image(two_by_two(), folder / "none/a.png").ok());
}

}  // namespace
}  // namespace bandsaw
