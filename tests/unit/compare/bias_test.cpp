// The test for bias between two images with independent noise: which bias it finds, and how often
// it raises a false alarm. It compares blocks of 16 x 16 pixels. The `t` of a block or of the image
// is the mean difference divided by its standard error. A block is suspicious if its |t| is too
// large.

#include "renderlib/compare/bias.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/render/pixel_groups.h"
#include "tests/unit/compare/pictures.h"

namespace bandsaw::test {
namespace {

constexpr std::uint64_t kSeed = 20;

/// Returns the image with uniform noise in [-strength / 2, strength / 2). The noise of a pixel is
/// the same in all channels and independent of other pixels.
Image noisy(const Image& image, float strength, std::uint64_t seed) {
  Random random(seed);
  Image out = image;
  for (Rgb& pixel : out.pixels) {
    pixel += gray(strength * static_cast<float>(random.uniform() - 0.5));
  }
  return out;
}

TEST(Bias, NoiseAloneIsNotBias) {
  const BiasTest test = test_bias(noisy(waves(128, 96), 0.1F, kSeed), waves(128, 96));
  EXPECT_EQ(test.blocks, 48u);  // 8 x 6
  EXPECT_LT(std::abs(test.t), 4);
  EXPECT_EQ(test.suspicious_blocks, 0u);
}

// Every pixel is darker by 0.001. This is a hundredth of the range of the noise, and a fifth of a
// per cent of the mean of the image, which is 1/2.
TEST(Bias, ABiasOfAHundredthOfTheNoiseIsFound) {
  Image darker = noisy(waves(512, 512), 0.1F, kSeed);
  for (Rgb& pixel : darker.pixels) {
    pixel += gray(-0.001F);
  }
  const BiasTest test = test_bias(darker, waves(512, 512));
  EXPECT_LT(test.t, -8);
  EXPECT_NEAR(test.relative_bias, -0.002, 0.0005);
}

TEST(Bias, OneBadBlockIsFound) {
  Image bad = noisy(waves(128, 96), 0.1F, kSeed);
  for (std::uint32_t y = 32; y < 48; ++y) {
    for (std::uint32_t x = 64; x < 80; ++x) {
      bad.pixels[std::size_t{y} * 128 + x] += gray(0.02F);
    }
  }
  const BiasTest test = test_bias(bad, waves(128, 96));
  EXPECT_EQ(test.suspicious_blocks, 1u);
  EXPECT_EQ(test.worst_x, 64u);
  EXPECT_EQ(test.worst_y, 32u);
  EXPECT_GT(test.worst_t, 5);
}

// bias.h states the rate of false alarms: one in a hundred images of independent noise.
TEST(Bias, FalseAlarmsAreAsRareAsStated) {
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Image image = uniform(64, 64, 0.5F);
    alarms += test_bias(noisy(image, 0.1F, seed), image).suspicious_blocks > 0 ? 1 : 0;
  }
  EXPECT_LE(alarms, 12);  // 4 expected; more than 12 has a probability below 1e-3
}

// A half tile (half of the pixels of a tile) is divided into groups of pixels. The pixels of a
// group have the same noise, as if they shared paths.
TEST(Bias, GroupsThatShareTheirNoiseAreNotBias) {
  constexpr TileGrid kGrid{64, 64};
  int alarms = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const Image image = uniform(kGrid.width, kGrid.height, 0.5F);
    Image shared = image;
    Random random(seed);
    for (std::size_t half_tile = 0; half_tile < kGrid.half_tiles(); ++half_tile) {
      const PixelGroups groups(kGrid, half_tile);
      for (std::uint32_t i = 0; i < groups.count(); ++i) {
        const auto noise = static_cast<float>(random.uniform() - 0.5);
        for (const auto& [x, y] : groups.group(i)) {
          shared.pixels[std::size_t{y} * kGrid.width + x] += gray(0.1F * noise);
        }
      }
    }
    alarms += test_bias(shared, image).suspicious_blocks > 0 ? 1 : 0;
  }
  EXPECT_LE(alarms, 12);  // 4 expected; more than 12 has a probability below 1e-3
}

// The last of 33 columns of pixels is 1.5 times as bright as in the reference. This
// column is the only one of the blocks at the right edge. Even so, its pixels do not count more
// than other pixels.
TEST(Bias, EveryPixelHasTheSameWeight) {
  Image image = uniform(33, 32, 1);
  for (std::uint32_t y = 0; y < 32; ++y) {
    image.pixels[std::size_t{33} * y + 32] = gray(1.5F);
  }
  EXPECT_NEAR(test_bias(image, uniform(33, 32, 1)).relative_bias, 0.5 / 33, 1e-6);
}

TEST(Bias, EqualImagesHaveNoBiasAndTinyOnesHaveNoBlocks) {
  EXPECT_EQ(test_bias(waves(20, 20), waves(20, 20)).t, 0);
  EXPECT_EQ(test_bias(uniform(2, 2, 1), uniform(2, 2, 0)).blocks, 0u);
}

}  // namespace
}  // namespace bandsaw::test
