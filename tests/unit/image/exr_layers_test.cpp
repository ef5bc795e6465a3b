// Layers of an EXR file: further images beside the main one, such as albedo or depth.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyexr.h>

#include <cstring>
#include <map>
#include <string>

#include "renderlib/image/exr.h"

namespace bandsaw {
namespace {

using ::testing::ElementsAre;

struct ReadChannel {
  int type_in_file = 0;
  std::vector<float> values;
};

/// Returns the channels of the file by name.
std::map<std::string, ReadChannel> channels_of(const std::vector<std::byte>& file) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(file.data());
  EXRVersion version;
  EXRHeader header;
  EXRImage image;
  InitEXRHeader(&header);
  InitEXRImage(&image);
  EXPECT_EQ(ParseEXRVersionFromMemory(&version, bytes, file.size()), TINYEXR_SUCCESS);
  EXPECT_EQ(ParseEXRHeaderFromMemory(&header, &version, bytes, file.size(), nullptr),
            TINYEXR_SUCCESS);
  std::map<std::string, ReadChannel> channels;
  for (int i = 0; i < header.num_channels; ++i) {
    channels[header.channels[i].name].type_in_file = header.pixel_types[i];
    header.requested_pixel_types[i] = TINYEXR_PIXELTYPE_FLOAT;
  }
  EXPECT_EQ(LoadEXRImageFromMemory(&image, &header, bytes, file.size(), nullptr), TINYEXR_SUCCESS);
  for (int i = 0; i < header.num_channels; ++i) {
    ReadChannel& to = channels[header.channels[i].name];
    to.values.resize(static_cast<std::size_t>(image.width * image.height));
    std::memcpy(to.values.data(), image.images[i], to.values.size() * sizeof(float));
  }
  FreeEXRImage(&image);
  FreeEXRHeader(&header);
  return channels;
}

const Image kImage{2, 1, {{1, 2, 3}, {4, 5, 6}}};
/// "albedo" is a layer of colours, and "depth" is a layer of one number per pixel.
const Layers kLayers = {{"albedo", {2, 1, {{0.25f, 0.5f, 0.75f}, {1, 0, 0}}}, /*is_number=*/false},
                        {"depth", {2, 1, {gray(1e6f), gray(3)}}, /*is_number=*/true}};

TEST(ExrLayers, AreStoredBesideTheImageUnderTheirNames) {
  const auto channels = channels_of(encode_exr(kImage, /*half=*/false, kLayers).value());
  ASSERT_EQ(channels.size(), 7u);  // three of the image, three of the albedo, one of the depth
  EXPECT_THAT(channels.at("R").values, ElementsAre(1, 4));
  EXPECT_THAT(channels.at("B").values, ElementsAre(3, 6));
  EXPECT_THAT(channels.at("albedo.R").values, ElementsAre(0.25f, 1));
  EXPECT_THAT(channels.at("albedo.G").values, ElementsAre(0.5f, 0));
  EXPECT_THAT(channels.at("depth.Z").values, ElementsAre(1e6f, 3));
}

TEST(ExrLayers, LayersOfNumbersStayFloatInAHalfFloatFile) {
  const auto channels = channels_of(encode_exr(kImage, /*half=*/true, kLayers).value());
  EXPECT_EQ(channels.at("R").type_in_file, TINYEXR_PIXELTYPE_HALF);
  EXPECT_EQ(channels.at("albedo.B").type_in_file, TINYEXR_PIXELTYPE_HALF);
  EXPECT_EQ(channels.at("depth.Z").type_in_file, TINYEXR_PIXELTYPE_FLOAT);
  EXPECT_THAT(channels.at("depth.Z").values, ElementsAre(1e6f, 3));
}

TEST(ExrLayers, LayersOfAnotherSizeAreRefused) {
  const Layers wrong = {{"albedo", {1, 1, {gray(1)}}, /*is_number=*/false}};
  EXPECT_EQ(encode_exr(kImage, /*half=*/false, wrong).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(ExrLayers, LongNamesAreRefused) {
  const Layers wrong = {{std::string(201, 'a'), kImage, /*is_number=*/false}};
  EXPECT_EQ(
      encode_exr(kImage, /*half=*/false, wrong).status(),
      absl::InvalidArgumentError("the name of a layer has 201 bytes, at most 200 are allowed"));
}

}  // namespace
}  // namespace bandsaw
