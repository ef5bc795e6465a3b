// The denoiser removes noise, keeps detail and reports an honest error. The bits of its result do
// not depend on the number of threads. The guides of an image are two images that show where edges
// are and have almost no noise. One shows the albedo, and one shows the normal and the distance.

#include "renderlib/denoise/denoise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "tests/support/random.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kWidth = 96;
constexpr std::uint32_t kHeight = 64;

using Picture = std::function<Rgb(std::uint32_t x, std::uint32_t y)>;

Image image_of(const Picture& picture) {
  Image image{kWidth, kHeight, {}};
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      image.pixels.push_back(picture(x, y));
    }
  }
  return image;
}

/// Returns a nearly normal number of mean 0 and variance 1: the sum of twelve uniform numbers.
float normal(test::Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) {
    sum += random.uniform(0, 1);
  }
  return static_cast<float>(sum);
}

/// Returns a noisy picture for the denoiser. The two halves of its samples have independent noise.
/// `noise` is the standard deviation of the mean of both halves. The guides are those of a grey
/// plane that faces the camera.
DenoiseInput noisy(const Picture& picture, float noise, std::uint64_t seed) {
  test::Random random(seed);
  const Image truth = image_of(picture);
  DenoiseInput input{truth, truth, std::vector<float>(truth.pixels.size(), 0.5f),
                     image_of([](auto, auto) { return gray(0.5f); }), image_of([](auto, auto) {
                       return Rgb{0.5f, 0.5f, 3};
                     })};
  const float of_half = noise * std::sqrt(2.0f);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    Rgb first = truth.pixels[i];
    Rgb second = truth.pixels[i];
    for (float* const channel : {&first.r, &first.g, &first.b, &second.r, &second.g, &second.b}) {
      *channel = std::max(0.0f, *channel + of_half * normal(random));
    }
    input.first.pixels[i] = first;
    input.mean.pixels[i] = (first + second) * 0.5f;
  }
  return input;
}

/// Denoises the image on `threads` threads.
Denoised denoised(const DenoiseInput& input, int threads = 2) {
  Pool pool(threads);
  return denoise(input, &fit, pool);
}

double rmse(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgb d = a.pixels[i] + b.pixels[i] * -1.0f;
    sum += double{d.r} * d.r + double{d.g} * d.g + double{d.b} * d.b;
  }
  return std::sqrt(sum / (3 * static_cast<double>(a.pixels.size())));
}

void expect_same_bits(const Image& a, const Image& b) {
  ASSERT_EQ(a.pixels.size(), b.pixels.size());
  const auto same = [](float x, float y) {
    return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
  };
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const Rgb& p = a.pixels[i];
    const Rgb& q = b.pixels[i];
    ASSERT_TRUE(same(p.r, q.r) && same(p.g, q.g) && same(p.b, q.b)) << "pixel " << i;
  }
}

Rgb flat(std::uint32_t, std::uint32_t) { return {0.4f, 0.5f, 0.6f}; }
Rgb ramp(std::uint32_t x, std::uint32_t y) {
  const auto u = static_cast<float>(x);
  const auto v = static_cast<float>(y);
  return {0.5f + 0.004f * u, 0.9f - 0.003f * v, 0.5f + 0.002f * u + 0.003f * v};
}

TEST(Denoise, ImageWithoutNoiseStaysToTheBit) {
  const DenoiseInput input = noisy(ramp, 0, 1);
  const Denoised clean = denoised(input);
  expect_same_bits(clean.image, input.mean);
  EXPECT_EQ(clean.total.rmse_clean, 0);
  EXPECT_EQ(clean.total.rmse_raw, 0);
}

TEST(Denoise, FlatImageLosesItsNoise) {
  const DenoiseInput input = noisy(flat, 0.05f, 2);
  const Denoised clean = denoised(input);
  const Image truth = image_of(flat);
  // With equal weights, the error would fall by sqrt(225 / 9) = 5: a window has 225 pixels, and the
  // regression has nine terms. Each pixel takes the mean of several windows, so the factor is
  // above 6.
  EXPECT_LT(rmse(clean.image, truth), rmse(input.mean, truth) / 6);
}

TEST(Denoise, LinearRampIsNotBent) {
  // The ramp rises in two directions. The mean over the seeds is the ramp, up to the noise that is
  // left.
  Image mean = image_of([](auto, auto) { return Rgb{}; });
  constexpr int kSeeds = 6;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const Denoised clean = denoised(noisy(ramp, 0.02f, 100 + static_cast<std::uint64_t>(seed)));
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
      mean.pixels[i] = mean.pixels[i] + clean.image.pixels[i] * (1.0f / kSeeds);
    }
  }
  EXPECT_LT(rmse(mean, image_of(ramp)), 0.02 / 6);
}

TEST(Denoise, TellsItsErrorWithoutAReference) {
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    const DenoiseInput input = noisy(ramp, 0.05f, seed);
    const Denoised clean = denoised(input);
    const Image truth = image_of(ramp);
    EXPECT_NEAR(clean.total.rmse_raw / rmse(input.mean, truth), 1, 0.05) << seed;
    // The estimate is a difference of two numbers that are much larger. So the tolerance is a share
    // of the noise, not of the estimate: 5 % of its variance, 0.05^2.
    const double estimate = clean.total.rmse_clean;
    EXPECT_LT(estimate, rmse(input.mean, truth) / 2) << seed;
    EXPECT_LT(std::abs(estimate * estimate - std::pow(rmse(clean.image, truth), 2)),
              0.05 * 0.05 * 0.05)
        << seed;
  }
}

// The halves of a Sobol' sequence complement each other: their errors have opposite signs, and
// their difference is larger than the noise of the image. The estimated error is then at least the
// noise that is left, not 0.
TEST(Denoise, NeverEstimatesLessThanTheNoiseThatIsLeft) {
  DenoiseInput input = noisy(flat, 0.2f, 31);
  for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
    const Rgb truth = flat(0, 0);
    input.mean.pixels[i] = truth + (input.mean.pixels[i] + truth * -1.0f) * 0.1f;
  }
  const Denoised clean = denoised(input);
  EXPECT_GT(clean.total.rmse_clean, 0);
  EXPECT_GT(clean.error.at(kWidth / 2, kHeight / 2).r, 0);
}

TEST(Denoise, TextureOfTheGuidesIsKept) {
  const Picture checks = [](std::uint32_t x, std::uint32_t y) {
    return gray((x / 4 + y / 4) % 2 == 0 ? 0.8f : 0.2f);
  };
  DenoiseInput input = noisy(checks, 0.1f, 6);
  input.albedo = image_of(checks);
  const Denoised clean = denoised(input);
  const Image truth = image_of(checks);
  EXPECT_LT(rmse(clean.image, truth), rmse(input.mean, truth) / 4);
}

// The only noise is at the edge of a lamp against a dark background: how many samples of a pixel
// hit the lamp. The guides know the share of the lamp, but no two pixels of the edge have the same
// one.
TEST(Denoise, TheNoiseOfAnEdgeIsRemovedWithTheGuides) {
  const auto share = [](std::uint32_t x, std::uint32_t y) {
    return std::clamp((static_cast<float>(x) - 30 - 0.37f * static_cast<float>(y)) / 1.5f, 0.0f,
                      1.0f);
  };
  const Picture lamp = [&](auto x, auto y) { return gray(4 * share(x, y)); };
  DenoiseInput input = noisy(lamp, 0, 9);
  input.albedo = image_of([&](auto x, auto y) { return gray(share(x, y)); });
  input.shape = image_of([&](auto x, auto y) { return Rgb{0.5f, 0.5f, 20 * share(x, y)}; });
  test::Random random(9);
  const auto half = [&](float hit) {
    int hits = 0;
    for (int sample = 0; sample < 8; ++sample) {
      hits += random.uniform(0, 1) < double{hit} ? 1 : 0;
    }
    return gray(4 * static_cast<float>(hits) / 8);
  };
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      const std::size_t i = std::size_t{y} * kWidth + x;
      input.first.pixels[i] = half(share(x, y));
      input.mean.pixels[i] = (input.first.pixels[i] + half(share(x, y))) * 0.5f;
    }
  }
  const Denoised clean = denoised(input);
  const Image truth = image_of(lamp);
  EXPECT_LT(rmse(clean.image, truth), rmse(input.mean, truth) / 1.5);
}

TEST(Denoise, DetailThatNoGuideShowsIsKeptWhereItExceedsTheNoise) {
  const Picture stripes = [](std::uint32_t x, std::uint32_t) {
    return gray(x % 2 == 0 ? 0.9f : 0.1f);
  };
  const DenoiseInput input = noisy(stripes, 0.01f, 7);
  const Denoised clean = denoised(input);
  const Image truth = image_of(stripes);
  EXPECT_LT(rmse(clean.image, truth), 1.05 * rmse(input.mean, truth));
}

TEST(Denoise, OneBrightPathIsNotSpread) {
  DenoiseInput input = noisy(flat, 0.05f, 8);
  const std::size_t at = 30 * kWidth + 41;
  input.first.pixels[at] = gray(2e4f);
  input.mean.pixels[at] = gray(1e4f);
  const Denoised clean = denoised(input);
  const Image truth = image_of(flat);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    ASSERT_LT(std::abs(clean.image.pixels[i].g - truth.pixels[i].g), 0.2f) << "pixel " << i;
  }
  // The reported error includes the error of the bright pixel.
  EXPECT_GT(clean.total.rmse_raw, 1);
}

// Each half has one bright path. They are in neighbouring pixels, so each half has a bright pixel
// near the bright pixel of the other half.
TEST(Denoise, BrightPathsInNeighbouringPixelsOfTheHalvesAreNotSpread) {
  DenoiseInput input = noisy(flat, 0.05f, 8);
  const std::size_t at = 30 * kWidth + 41;
  input.first.pixels[at] = gray(2e4f);
  input.mean.pixels[at] = gray(1e4f);
  input.mean.pixels[at + 1] = gray(1e4f);  // all of it is in the second half
  const Denoised clean = denoised(input);
  const Image truth = image_of(flat);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    ASSERT_LT(std::abs(clean.image.pixels[i].g - truth.pixels[i].g), 0.2f) << "pixel " << i;
  }
}

// The reflection of a lamp is two pixels wide, and both halves have it.
TEST(Denoise, ASmallBrightDetailStaysAsItWasRenderedAndIsNotSpread) {
  DenoiseInput input = noisy(flat, 0.05f, 10);
  const std::size_t at = 30 * kWidth + 41;
  for (std::size_t i = at; i < at + 2; ++i) {
    input.first.pixels[i] = gray(280);
    input.mean.pixels[i] = gray(300);
  }
  const Denoised clean = denoised(input);
  const Image truth = image_of(flat);
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    if (i == at || i == at + 1) {
      EXPECT_EQ(clean.image.pixels[i], input.mean.pixels[i]);
    } else {
      ASSERT_LT(std::abs(clean.image.pixels[i].g - truth.pixels[i].g), 0.2f) << "pixel " << i;
    }
  }
}

// In one pixel of 32, a half has a bright path. In a pixel in which both halves have one by chance,
// the rendered value seems to be much better than the filtered one.
TEST(Denoise, PixelsThatAreBrightInBothHalvesByChanceLeaveNoNoisyPatches) {
  std::uint32_t noisy_pixels = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DenoiseInput input = noisy(flat, 0.05f, seed);
    test::Random random(seed);
    for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
      const float first = random.uniform(0, 1) < 1.0 / 32 ? 1.0f : 0.0f;
      const float second = random.uniform(0, 1) < 1.0 / 32 ? 1.0f : 0.0f;
      input.first.pixels[i] += gray(first);
      input.mean.pixels[i] += gray((first + second) / 2);
    }
    for (const Rgb& pixel : denoised(input).image.pixels) {
      noisy_pixels += std::abs(pixel.g - (flat(0, 0).g + 1.0f / 32)) > 0.1f ? 1u : 0u;
    }
  }
  // Fewer than one pixel in 1,000. If the smaller estimate alone decided, it would be 68 pixels.
  EXPECT_LT(noisy_pixels, 10 * kWidth * kHeight / 1000)
      << noisy_pixels << " of " << 10 * kWidth * kHeight << " pixels";
}

// The halves complement each other, as in NeverEstimatesLessThanTheNoiseThatIsLeft. The waves are
// weaker than the noise of a half, so the filter flattens them. Only the comparison of neighbouring
// pixels can find this bias.
TEST(Denoise, TheEstimatedErrorContainsTheBiasThatNeighboursHaveInCommon) {
  const Picture waves = [](std::uint32_t x, std::uint32_t) {
    return gray(0.5f + 0.04f * std::sin(0.6f * static_cast<float>(x)));
  };
  const Image truth = image_of(waves);
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    DenoiseInput input = noisy(waves, 0.1f, seed);
    for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
      const Rgb& wave = truth.pixels[i];
      const Rgb complement = wave + (input.first.pixels[i] + wave * -1.0f) * -0.8f;
      input.mean.pixels[i] = (input.first.pixels[i] + complement) * 0.5f;
    }
    const Denoised clean = denoised(input);
    const double ratio = clean.total.rmse_clean / rmse(clean.image, truth);
    EXPECT_GT(ratio, 0.7) << seed;
    EXPECT_LT(ratio, 1.5) << seed;
    EXPECT_GT(clean.total.bias_share, 0.5) << seed;
  }
}

TEST(Denoise, ValuesThatAreNotFiniteStayAndHarmNoOthers) {
  DenoiseInput input = noisy(flat, 0.05f, 9);
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  input.mean.pixels[10 * kWidth + 10] = {nan, 1, 1};
  input.mean.pixels[20 * kWidth + 20] = {inf, inf, inf};
  input.first.pixels[30 * kWidth + 30] = {-inf, 0, 0};
  input.albedo.pixels[40 * kWidth + 40] = {nan, nan, nan};
  input.shape.pixels[41 * kWidth + 41] = {nan, inf, inf};
  const Denoised clean = denoised(input);
  EXPECT_TRUE(std::isnan(clean.image.pixels[10 * kWidth + 10].r));
  EXPECT_EQ(clean.image.pixels[20 * kWidth + 20].r, inf);
  for (std::size_t i = 0; i < clean.image.pixels.size(); ++i) {
    if (i != 10 * kWidth + 10 && i != 20 * kWidth + 20) {
      ASSERT_TRUE(is_finite(clean.image.pixels[i])) << "pixel " << i;
      ASSERT_NEAR(clean.image.pixels[i].g, 0.5f, 0.3f) << "pixel " << i;
    }
  }
  EXPECT_TRUE(std::isfinite(clean.total.rmse_clean));
}

// In red the two parts of the samples are 1.1e30 and 0.9e30, so the error of their mean is 0.1e30.
// The mean of all channels is 1e30 / 3, and the mean of the squared errors is (0.1e30)^2 / 3.
TEST(Denoise, PixelsTooBrightForTheFiltersStayAndCountInTheError) {
  DenoiseInput input = noisy(flat, 0, 13);
  for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
    input.first.pixels[i] = {1.1e30f, 2, 0.5f};
    input.mean.pixels[i] = {1e30f, 2, 0.5f};
  }
  const Denoised clean = denoised(input);
  expect_same_bits(clean.image, input.mean);
  EXPECT_NEAR(clean.total.mean / 1e30, 1.0 / 3, 1e-5);
  EXPECT_NEAR(clean.total.relative_raw(), 0.1 * std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(clean.total.relative_clean(), 0.1 * std::sqrt(3.0), 1e-5);
}

TEST(Denoise, TheErrorLeavesOutPixelsThatAreNotFinite) {
  DenoiseInput input = noisy(flat, 0.05f, 14);
  for (std::size_t i = 0; i < input.mean.pixels.size(); i += 2) {
    input.mean.pixels[i] = gray(std::numeric_limits<float>::quiet_NaN());
  }
  const Denoised clean = denoised(input);
  EXPECT_NEAR(clean.total.mean, 0.5, 0.01);
  EXPECT_NEAR(clean.total.rmse_raw / 0.05, 1, 0.05);
}

TEST(Denoise, AcceptsPartsOfDifferentSizes) {
  // The second part has three times as many samples as the first.
  DenoiseInput input = noisy(flat, 0.05f, 10);
  test::Random random(11);
  for (std::size_t i = 0; i < input.mean.pixels.size(); ++i) {
    const float first = 0.5f + 0.1f * normal(random);
    const float second = 0.5f + 0.1f / std::sqrt(3.0f) * normal(random);
    input.first.pixels[i] = gray(first);
    input.mean.pixels[i] = gray(0.25f * first + 0.75f * second);
    input.first_share[i] = 0.25f;
  }
  const Denoised clean = denoised(input);
  const Image truth = image_of([](auto, auto) { return gray(0.5f); });
  EXPECT_NEAR(clean.total.rmse_raw / rmse(input.mean, truth), 1, 0.1);
  // The error falls by a smaller factor than in other tests. Grey noise is equal in all channels,
  // so the patches of two pixels are compared less precisely.
  EXPECT_LT(rmse(clean.image, truth), rmse(input.mean, truth) / 3);
}

TEST(Denoise, HasTheSameBitsForAnyNumberOfThreads) {
  const DenoiseInput input = noisy(ramp, 0.05f, 12);
  const Denoised one = denoised(input, 1);
  for (const int threads : {2, 3}) {
    const Denoised more = denoised(input, threads);
    expect_same_bits(one.image, more.image);
    expect_same_bits(one.error, more.error);
    EXPECT_EQ(one.total, more.total);
  }
}

// The image is denoised in strips of rows, each together with a margin of rows around the strip.
// The filters reach no farther than this margin. So a pixel does not depend on where the strips
// begin, and there are no seams between strips.
TEST(Denoise, HasTheSameBitsForAnyHeightOfTheStrips) {
  const DenoiseInput input = noisy(
      [](std::uint32_t x, std::uint32_t y) { return gray(x / 13 % 2 == y / 9 % 2 ? 0.2f : 0.8f); },
      0.1f, 21);
  Pool pool(2);
  const Denoised whole = denoise(input, &fit, pool, kHeight);
  for (const int rows : {2, 6, 16, 38}) {
    const Denoised strips = denoise(input, &fit, pool, rows);
    expect_same_bits(whole.image, strips.image);
    expect_same_bits(whole.error, strips.error);
    EXPECT_EQ(whole.total, strips.total) << rows;
  }
}

TEST(Denoise, WorksOnTheSmallestImages) {
  for (const std::uint32_t width : {1u, 2u, 3u, 17u}) {
    Image one{width, 1, std::vector<Rgb>(width, gray(0.5f))};
    Image first = one;
    first.pixels[0] = gray(0.4f);
    const DenoiseInput input{one, first, std::vector<float>(width, 0.5f), one, one};
    const Denoised clean = denoised(input);
    ASSERT_EQ(clean.image.pixels.size(), width);
    EXPECT_NEAR(clean.image.pixels[0].r, 0.5f, 0.1f);
  }
}

}  // namespace
}  // namespace bandsaw
