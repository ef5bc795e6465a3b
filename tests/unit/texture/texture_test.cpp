// Image textures: orientation, wrapping, filtering and encodings. An id such as TX2 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/texture/texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "renderlib/geometry/sphere_uv.h"
#include "renderlib/image/srgb.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

using Filter = ImageTexture::Filter;
using Format = ImageTexture::Format;
using Wrap = ImageTexture::Wrap;

/// Returns an image whose texel (x, y), counted from the top left, has the value 10 y + x in all
/// channels.
Texture counted(std::uint32_t width, std::uint32_t height, Wrap wrap, Filter filter) {
  ImageTexture image;
  image.width = width;
  image.height = height;
  image.format = Format::kFloat32;
  image.wrap = wrap;
  image.filter = filter;
  std::vector<std::byte> texels;
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const auto value = static_cast<float>(10 * (i / width) + i % width);
    const float texel[3] = {value, value, value};
    const auto* bytes = reinterpret_cast<const std::byte*>(texel);
    texels.insert(texels.end(), bytes, bytes + sizeof texel);
  }
  image.texels = std::move(texels);
  return image;
}

/// Returns an image whose texels have the codes `values`, three for each texel, in rows of `width`
/// texels.
Texture codes(Format format, std::vector<std::uint8_t> values, std::uint32_t width) {
  ImageTexture image;
  image.width = width;
  image.height = static_cast<std::uint32_t>(values.size()) / 3 / width;
  image.format = format;
  std::vector<std::byte> texels;
  for (const std::uint8_t value : values) {
    texels.push_back(std::byte{value});
  }
  image.texels = std::move(texels);
  return image;
}

Rgb evaluate(const Texture& texture, const Vec2& uv) {
  return bandsaw::evaluate(absl::MakeConstSpan(&texture, 1), TextureId{0}, {.uv = uv});
}
float max_value(const Texture& texture) {
  return bandsaw::max_value(absl::MakeConstSpan(&texture, 1), TextureId{0});
}
Rgb mean(const Texture& texture) {
  return bandsaw::mean(absl::MakeConstSpan(&texture, 1), TextureId{0});
}
float at(const Texture& texture, double u, double v) { return evaluate(texture, {u, v}).g; }

TEST(Texture, AConstantIsItselfEverywhere) {
  const Texture texture = ConstantTexture{{1, 2, 3}};
  EXPECT_EQ(evaluate(texture, {7, -3}), (Rgb{1, 2, 3}));
  EXPECT_EQ(mean(texture), (Rgb{1, 2, 3}));
  EXPECT_EQ(max_value(texture), 3);
}

TEST(Texture, UvBeginsAtTheBottomLeft) {
  const Texture texture = counted(4, 3, Wrap::kClamp, Filter::kNearest);
  EXPECT_EQ(at(texture, 0.01, 0.01), 20);
  EXPECT_EQ(at(texture, 0.99, 0.01), 23);
  EXPECT_EQ(at(texture, 0.01, 0.99), 0);
  EXPECT_EQ(at(texture, 0.6, 0.5), 12);
}

TEST(Texture, TX2TX3LookupsNeverReadOutsideTheImage) {
  for (const Wrap wrap : {Wrap::kRepeat, Wrap::kClamp, Wrap::kMirror}) {
    for (const Filter filter : {Filter::kBilinear, Filter::kNearest}) {
      const Texture texture = counted(4, 3, wrap, filter);
      for (const double u : {0.0, 1.0, -1e-20, 1 - 0x1p-53, 1e7, 1e15, -1e15, 1e308, -0.0, 2.0,
                             -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
        for (const double v : {0.0, 1.0, -1e-20, 1e300, 0.5}) {
          for (const auto& [a, b] : {std::pair{u, v}, std::pair{v, u}}) {
            const float value = at(texture, a, b);
            ASSERT_GE(value, 0) << a << " " << b;
            ASSERT_LE(value, 23) << a << " " << b;
          }
        }
      }
    }
  }
  test::report_hard_case("TX2", "the texel index is inside the image for -1e-20");
  test::report_hard_case("TX3", "the texel index is inside the image up to 1e308");
}

TEST(Texture, TX1TheCornersShowTheCornerTexels) {
  const Texture texture = counted(4, 3, Wrap::kClamp, Filter::kNearest);
  EXPECT_EQ(at(texture, 0, 0), 20);
  EXPECT_EQ(at(texture, 1, 0), 23);
  EXPECT_EQ(at(texture, 0, 1), 0);
  EXPECT_EQ(at(texture, 1, 1), 3);
  test::report_hard_case("TX1", "coordinates 0 and 1 give the corner texels");
}

TEST(Texture, WrapModesRepeatClampAndMirror) {
  const auto u_of = [](double texel) { return (texel + 0.5) / 4; };
  for (const Filter filter : {Filter::kBilinear, Filter::kNearest}) {
    const Texture repeat = counted(4, 1, Wrap::kRepeat, filter);
    const Texture clamp = counted(4, 1, Wrap::kClamp, filter);
    const Texture mirror = counted(4, 1, Wrap::kMirror, filter);
    for (int texel = -9; texel < 12; ++texel) {
      const int period = ((texel % 8) + 8) % 8;
      EXPECT_NEAR(at(repeat, u_of(texel), 0.5), period % 4, 1e-5);
      EXPECT_NEAR(at(clamp, u_of(texel), 0.5), std::min(std::max(texel, 0), 3), 1e-5);
      EXPECT_NEAR(at(mirror, u_of(texel), 0.5), period < 4 ? period : 7 - period, 1e-5);
    }
  }
}

TEST(Texture, BilinearIsLinearBetweenTexelsAndAcrossTheSeam) {
  const Texture texture = counted(4, 1, Wrap::kRepeat, Filter::kBilinear);
  EXPECT_NEAR(at(texture, 0.25, 0.5), 0.5, 1e-6);
  EXPECT_NEAR(at(texture, 0.30, 0.5), 0.7, 1e-6);
  EXPECT_NEAR(at(texture, 0.0, 0.5), 1.5, 1e-6);
  EXPECT_NEAR(at(texture, 1e7 + 0.25, 0.5), 0.5, 1e-2);
}

TEST(Texture, FilteringIsDoneOnLinearValues) {
  const Texture texture = codes(Format::kSrgb8, {0, 0, 0, 255, 255, 255}, 2);
  EXPECT_NEAR(at(texture, 0.5, 0.5), 0.5, 1e-6);
  EXPECT_NEAR(mean(texture).g, 0.5, 1e-6);
  EXPECT_EQ(max_value(texture), 1);
}

TEST(Texture, CodesAreDecodedByTheirFormat) {
  EXPECT_EQ(evaluate(codes(Format::kSrgb8, {10, 128, 255}, 1), {0.3, 0.3}),
            (Rgb{srgb_table()[10], srgb_table()[128], 1}));
  EXPECT_EQ(evaluate(codes(Format::kLinear8, {0, 51, 255}, 1), {0.3, 0.3}), (Rgb{0, 0.2f, 1}));
}

TEST(Texture, TX8AnImageOfOneColorIsThatColorToTheBit) {
  const Texture image = codes(Format::kSrgb8, {77, 88, 99, 77, 88, 99, 77, 88, 99, 77, 88, 99}, 2);
  const Rgb color{srgb_table()[77], srgb_table()[88], srgb_table()[99]};
  for (double u = -2; u < 2; u += 0.0137) {
    ASSERT_EQ(evaluate(image, {u, 3 * u}), color);
  }
}

TEST(Texture, GreyIsTheSameInEveryChannelAtAThirdOfTheBytes) {
  ImageTexture image;
  image.width = 2;
  image.height = 1;
  image.channels = 1;
  image.texels = std::vector<std::byte>{std::byte{10}, std::byte{200}};
  EXPECT_EQ(texel_bytes(image), 2u);
  EXPECT_EQ(evaluate(image, {0.25, 0.5}), gray(srgb_table()[10]));
  EXPECT_EQ(evaluate(image, {0.75, 0.5}), gray(srgb_table()[200]));
  EXPECT_EQ(mean(image).r, mean(image).b);
}

TEST(Texture, UsesTheTransformAndTheUvSetOfTheImage) {
  Texture texture = counted(4, 3, Wrap::kRepeat, Filter::kNearest);
  auto& image = std::get<ImageTexture>(texture);
  image.uv_set = UvSet::kSecond;
  image.uv_transform = {{0, -1, 1, 2, 0, 0}};
  const TextureCoordinates at{.uv = {9, 9}, .uv2 = {0.4, 0.3}};
  // The transform gives (1 - 0.3, 2 * 0.4), which is in column 2 of the top row.
  EXPECT_EQ(bandsaw::evaluate(absl::MakeConstSpan(&texture, 1), TextureId{0}, at).g, 2);
}

TEST(Texture, MayWrapDifferentlyInUAndV) {
  Texture texture = counted(4, 3, Wrap::kRepeat, Filter::kBilinear);
  std::get<ImageTexture>(texture).wrap_v = Wrap::kClamp;
  EXPECT_EQ(at(texture, 0.125, 1), 0);
  EXPECT_EQ(at(texture, 1.125, 7), 0);
  EXPECT_EQ(at(texture, 0.125, 0), 20);
  EXPECT_EQ(at(texture, -0.125, -5), 23);
}

TEST(Texture, TX7HasNoSeamOnASphere) {
  // The image has 64 x 32 texels. Its first and last columns are equal, and its values grow from
  // the top row to the bottom row, that is, from pole to pole. Points on either side of the seam
  // that are close together must differ by less than two texel steps (the step from row to row is
  // 4/255). At a point close to a pole, the value must be within two texel steps of one texel of
  // the outermost row: the texel that lies in the direction of the point.
  ImageTexture image;
  image.width = 64;
  image.height = 32;
  image.wrap_v = Wrap::kClamp;
  image.channels = 1;
  image.format = Format::kLinear8;
  std::vector<std::byte> texels;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      texels.push_back(std::byte(3 * std::min(x, 63 - x) + 4 * y));
    }
  }
  image.texels = std::move(texels);
  const auto on_sphere = [&](const Vec3& p) { return evaluate(image, sphere_uv(normalize(p))).g; };
  constexpr float kTwoSteps = 2 * 4 / 255.0f;
  for (double y = -20; y <= 20; y += 0.37) {
    EXPECT_NEAR(on_sphere({-1, y, 1e-9}), on_sphere({-1, y, -1e-9}), kTwoSteps);
    EXPECT_NEAR(on_sphere({-1, y, 0.0}), on_sphere({-1, y, -0.0}), kTwoSteps);
  }
  for (const double pole : {-1.0, 1.0}) {
    const float row = pole > 0 ? 0 : 4 * 31 / 255.0f;
    EXPECT_NEAR(on_sphere({1e-12, pole, 0}), row + 3 * 31.5f / 255, kTwoSteps);
    EXPECT_NEAR(on_sphere({-1e-12, pole, 1e-13}), row, kTwoSteps);
  }
  test::report_hard_case("TX7", "step at the seam and the poles at most 2 texel steps");
}

TEST(Texture, TX3FarRepetitionsAreWithinAHundredthOfATexel) {
  const Texture texture = counted(4, 3, Wrap::kRepeat, Filter::kBilinear);
  for (const double turns : {1e3, 1e5, 1e7}) {
    for (const double u : {0.2, 0.45, 0.7}) {
      EXPECT_NEAR(at(texture, u + turns, 0.5), at(texture, u, 0.5), 0.01) << turns << " " << u;
    }
  }
  test::report_hard_case("TX3", "position within 0.01 texel");
}

TEST(Texture, TX6MayBeASinglePixelOrALine) {
  EXPECT_EQ(at(codes(Format::kLinear8, {0, 51, 0}, 1), 0.3, 77.7), 0.2f);
  const Texture line = codes(Format::kLinear8, std::vector<std::uint8_t>(3 * 16384, 255), 16384);
  for (const double u : {0.0, 1.0, 0.99999, -1e-20}) {
    EXPECT_EQ(at(line, u, u), 1);
  }
  test::report_hard_case("TX6", "textures of one texel and of one row are correct");
}

}  // namespace
}  // namespace bandsaw
