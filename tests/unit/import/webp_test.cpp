// Tests how WebP images are read, alone and as textures of glTF files. The encoder of the WebP
// library makes the images.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <webp/encode.h>

#include "absl/strings/escaping.h"
#include "renderlib/import/image/decode_image.h"
#include "tests/support/random.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::GltfWriter;
using test::TempDir;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kWidth = 13;
constexpr int kHeight = 7;

/// Returns random 8-bit codes for an image with this number of channels.
std::vector<std::uint8_t> codes(std::size_t channels) {
  test::Random random(5);
  std::vector<std::uint8_t> out;
  for (std::size_t i = 0; i < channels * kWidth * kHeight; ++i) {
    out.push_back(static_cast<std::uint8_t>(random.below(256)));
  }
  return out;
}

/// Returns a WebP file with exactly these pixels, RGB or RGBA.
std::string lossless(const std::vector<std::uint8_t>& pixels, bool has_alpha) {
  std::uint8_t* out = nullptr;
  const std::size_t size =
      has_alpha ? WebPEncodeLosslessRGBA(pixels.data(), kWidth, kHeight, 4 * kWidth, &out)
                : WebPEncodeLosslessRGB(pixels.data(), kWidth, kHeight, 3 * kWidth, &out);
  std::string bytes(reinterpret_cast<const char*>(out), size);
  WebPFree(out);
  return bytes;
}

/// Returns the bytes of the texels of an image.
std::vector<std::uint8_t> texels(const ImageTexture& image) {
  std::vector<std::uint8_t> out;
  for (const std::byte b : image.texels) {
    out.push_back(static_cast<std::uint8_t>(b));
  }
  return out;
}

TEST(Webp, LosslessImagesKeepTheirTexels) {
  std::vector<std::string> warnings;
  const auto image = decode_image(lossless(codes(3), /*has_alpha=*/false), warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->width, 13u);
  EXPECT_EQ(image->height, 7u);
  EXPECT_EQ(image->format, ImageTexture::Format::kSrgb8);
  EXPECT_EQ(texels(*image), codes(3));
  EXPECT_THAT(warnings, IsEmpty());
}

TEST(Webp, AlphaIsLeftOutOfTheColourAndReadSeparately) {
  // By default the encoder does not keep the colour of fully transparent texels. So no texel of
  // this image is fully transparent.
  std::vector<std::uint8_t> rgba = codes(4);
  std::vector<std::uint8_t> rgb;
  std::vector<std::uint8_t> alpha;
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    rgba[i + 3] |= 1;
    rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    alpha.push_back(rgba[i + 3]);
  }
  const std::string bytes = lossless(rgba, /*has_alpha=*/true);
  std::vector<std::string> warnings;
  const auto image = decode_image(bytes, warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(texels(*image), rgb);
  EXPECT_THAT(warnings, ElementsAre(kAlphaWarning));
  EXPECT_TRUE(image_has_alpha(bytes));
  const auto read = decode_alpha(bytes);
  ASSERT_TRUE(read.ok()) << read.status();
  EXPECT_EQ(texels(*read), alpha);
}

// The image is a smooth ramp, encoded with quality 90. Its error is a few 8-bit codes.
TEST(Webp, LossyImagesAreNearTheirTexels) {
  constexpr int kSide = 64;
  std::vector<std::uint8_t> ramp;
  for (int i = 0; i < kSide * kSide; ++i) {
    const auto v = static_cast<std::uint8_t>(60 + 2 * (i % kSide));
    ramp.insert(ramp.end(), {v, v, v});
  }
  std::uint8_t* out = nullptr;
  const std::size_t size = WebPEncodeRGB(ramp.data(), kSide, kSide, 3 * kSide, 90, &out);
  const std::string bytes(reinterpret_cast<const char*>(out), size);
  WebPFree(out);
  std::vector<std::string> warnings;
  const auto image = decode_image(bytes, warnings);
  ASSERT_TRUE(image.ok()) << image.status();
  const auto found = texels(*image);
  ASSERT_EQ(found.size(), ramp.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_NEAR(found[i], ramp[i], 8) << i;
  }
}

TEST(Webp, DamagedAndAnimatedImagesAreErrors) {
  const std::string whole = lossless(codes(3), /*has_alpha=*/false);
  std::vector<std::string> warnings;
  // The first 12 bytes tell that a file is WebP, and the last byte may be padding.
  for (std::size_t size = 12; size < whole.size() - 1; ++size) {
    const auto cut = decode_image(whole.substr(0, size), warnings);
    EXPECT_EQ(cut.status().code(), absl::StatusCode::kInvalidArgument) << size;
  }
  // The extended header (VP8X) says that the file is an animation of 1 x 1 pixels.
  std::string animated("RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\x02\0\0\0\0\0\0\0\0\0", 30);
  EXPECT_THAT(std::string(decode_image(animated, warnings).status().message()),
              HasSubstr("is an animated WebP image"));
}

// With EXT_texture_webp the WebP image is used even if the texture has another source. The image is
// a file, a part of the buffer, or a data URI.
TEST(Webp, TexturesOfGltfFilesMayBeWebp) {
  const TempDir folder;
  const std::string webp = lossless(codes(3), /*has_alpha=*/false);
  write_text(folder, "w.webp", webp);
  GltfWriter file;
  file.attributes() = {{"POSITION", file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)},
                       {"TEXCOORD_0", file.add<float>({0, 0, 1, 0, 0, 1}, 2)}};
  file.primitive()["material"] = 0;
  file.root["materials"] =
      test::Json::parse(R"([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}])");
  file.root["textures"] =
      test::Json::parse(R"([{"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}}])");
  file.root["extensionsUsed"] = {"EXT_texture_webp"};
  const std::size_t view = file.view(webp);
  const test::Json images[] = {{{"uri", "w.webp"}},
                               {{"bufferView", view}, {"mimeType", "image/webp"}},
                               {{"uri", "data:image/webp;base64," + absl::Base64Escape(webp)}}};
  for (const test::Json& image : images) {
    file.root["images"] = test::Json::array({{{"uri", "fallback.png"}}, image});
    const auto imported = file.import(folder);
    ASSERT_TRUE(imported.ok()) << imported.status();
    EXPECT_THAT(imported->info.warnings, IsEmpty());
    const auto& material = std::get<MetallicRoughness>(imported->scene.materials.at(0).kind);
    EXPECT_EQ(texels(std::get<ImageTexture>(
                  imported->scene.textures.at(index_of(material.base_color.texture)))),
              codes(3));
  }
  file.root["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 2;
  EXPECT_THAT(std::string(file.import(folder).status().message()),
              HasSubstr("textures[0].EXT_texture_webp: images[2] does not exist"));
}

}  // namespace
}  // namespace bandsaw
