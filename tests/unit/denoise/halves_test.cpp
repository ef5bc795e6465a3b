// The error and the bias of a filter, estimated from two independent parts of the samples. The
// parts are called halves, but need not have the same size.

#include "renderlib/denoise/halves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/random.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kSide = 128;

/// Returns a nearly normal number of mean 0 and variance 1: the sum of twelve uniform numbers.
float gaussian(test::Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) {
    sum += random.uniform(0, 1);
  }
  return static_cast<float>(sum);
}

/// The filter: returns the mean of each pixel and its left and right neighbours, plus `bias`.
Image filtered(const Image& image, float bias) {
  Image out = image;
  for (std::uint32_t y = 0; y < kSide; ++y) {
    for (std::uint32_t x = 1; x + 1 < kSide; ++x) {
      out.pixels[y * kSide + x] =
          (image.at(x - 1, y) + image.at(x, y) + image.at(x + 1, y)) * (1.0f / 3) + gray(bias);
    }
  }
  return out;
}

// The noise of a pixel has the standard deviation 0.1. The mean of three pixels has the standard
// deviation 0.1 / sqrt(3). The image has 3 x 16,384 values, so their root mean square is known to
// 0.5 %. The tolerance is ten times as large.
TEST(Halves, TellErrorAndBiasOfALinearFilter) {
  test::Random random(3);
  const float share = 0.25f;
  const Image truth{kSide, kSide, std::vector<Rgb>(kSide * kSide, gray(1))};
  DenoiseInput input{truth, truth, std::vector<float>(kSide * kSide, share), truth, truth};
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    // Returns the mean of the samples of a part; `part` is its share in all samples.
    const auto of_part = [&](float part) {
      const float deviation = 0.1f / std::sqrt(part);
      return Rgb{1 + deviation * gaussian(random), 1 + deviation * gaussian(random),
                 1 + deviation * gaussian(random)};
    };
    const Rgb first = of_part(share);
    const Rgb second = of_part(1 - share);
    input.first.pixels[i] = first;
    input.mean.pixels[i] = first * share + second * (1 - share);
  }
  Pool pool(1);
  const float bias = 0.05f;
  const Denoised clean =
      with_error_of_halves(input, filtered(input.mean, bias), filtered(input.first, bias),
                           filtered(second_part(input), bias), pool);
  const double variance = 0.01 / 3;  // of a filtered pixel
  EXPECT_NEAR(clean.total.rmse_raw, 0.1, 0.005);
  EXPECT_NEAR(clean.total.rmse_clean, std::sqrt(variance + bias * bias), 0.005);
  EXPECT_NEAR(clean.total.bias_share, bias * bias / (variance + bias * bias), 0.05);
  EXPECT_NEAR(clean.total.mean, 1, 0.01);
}

// The noise of the halves is opposite, as in samples that complement each other, so the image has
// no error, but the difference of the halves is large. The clean image has the error 0.08 of the
// bias.
TEST(Halves, TellABiasThatOppositeNoiseHides) {
  test::Random random(4);
  const Image truth{kSide, kSide, std::vector<Rgb>(kSide * kSide, gray(1))};
  DenoiseInput input{truth, truth, std::vector<float>(kSide * kSide, 0.5f), truth, truth};
  for (Rgb& pixel : input.first.pixels) {
    pixel = gray(1 + 0.1f * gaussian(random));
  }
  Pool pool(1);
  const float bias = 0.08f;
  const Denoised clean =
      with_error_of_halves(input, filtered(input.mean, bias), filtered(input.first, bias),
                           filtered(second_part(input), bias), pool);
  EXPECT_GT(clean.total.rmse_clean, 0.08);
  EXPECT_LT(clean.total.rmse_clean, 0.16);
}

// The image as rendered has 4 samples per pixel and no parts. It becomes the second part, and 2
// further samples per pixel become the first part. Each sample has the standard deviation 0.2. The
// image as rendered has the error 0.1, and all samples together have the error 0.2 / sqrt(6). The
// tolerance is as above.
TEST(Halves, FurtherSamplesAndTheImageAreTheTwoPartsWithTheirErrors) {
  test::Random random(5);
  const auto noisy = [&](double deviation) {
    Image image{kSide, kSide, {}};
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      image.pixels.push_back(gray(1 + static_cast<float>(deviation) * gaussian(random)));
    }
    return image;
  };
  Image rendered = noisy(0.1);
  rendered.pixels[7] = gray(std::numeric_limits<float>::infinity());
  const Image flat{kSide, kSide, std::vector<Rgb>(kSide * kSide, gray(0.5f))};
  DenoiseInput input;
  input.albedo = input.shape = flat;
  add_samples(rendered, 4, noisy(0.2 / std::sqrt(2)), 2, input);
  EXPECT_EQ(input.mean.pixels[7], rendered.pixels[7]);
  EXPECT_EQ(input.first_share[7], 0);
  EXPECT_FLOAT_EQ(input.first_share[8], 1.0f / 3);
  EXPECT_FLOAT_EQ(second_part(input).pixels[8].r, rendered.pixels[8].r);
  Pool pool(1);
  const Denoised same =
      with_error_of_halves(input, input.mean, input.first, second_part(input), pool);
  EXPECT_NEAR(same.total.rmse_raw, 0.1, 0.005);
  EXPECT_NEAR(same.total.rmse_clean, 0.2 / std::sqrt(6), 0.005);
  EXPECT_EQ(denoise(input, fit, pool).image.pixels[7], rendered.pixels[7]);
}

// The two parts of the samples are 1.1 and 0.9, or 0.9 and 1.1 in every second row. So the estimated
// error of their mean is 0.1.
TEST(Halves, LeaveOutPixelsThatAreNotFinite) {
  const Image mean{kSide, kSide, std::vector<Rgb>(kSide * kSide, gray(1))};
  DenoiseInput input{mean, mean, std::vector<float>(kSide * kSide, 0.5f), mean, mean};
  for (std::size_t i = 0; i < input.first.pixels.size(); ++i) {
    // The noise of neighbours must not have the same sign, because that would count as bias.
    input.first.pixels[i] = gray(i / kSide % 2 == 0 ? 1.1f : 0.9f);
  }
  for (std::size_t i = 0; i < input.mean.pixels.size(); i += 2) {
    input.mean.pixels[i] = gray(std::numeric_limits<float>::quiet_NaN());
  }
  Pool pool(1);
  const Denoised clean =
      with_error_of_halves(input, input.mean, input.first, second_part(input), pool);
  EXPECT_NEAR(clean.total.mean, 1, 1e-5);
  EXPECT_NEAR(clean.total.rmse_raw, 0.1, 1e-5);
  EXPECT_NEAR(clean.total.rmse_clean, 0.1, 1e-5);
}

}  // namespace
}  // namespace bandsaw
