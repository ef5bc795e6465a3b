// Tests the hard cases A1, A2, A8, C7, L2, L5, L10, P2, P3, P4, R3 and R9, in which numbers can
// lose precision (cases.txt).
//
// In texts, u is the unit roundoff of double, 2^-53.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <set>
#include <string>

#include "renderlib/image/exr.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_exr.h"
#include "renderlib/integrate/mis.h"
#include "renderlib/render/film.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/sampling/spherical_rectangle.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Random;
using test::tries;
using test::Wide;
using test::wide_sqrt;
using test::Worst;

constexpr double kUnit = 0x1p-53;

TEST(Cone, L2_NarrowConesKeepTheirDigits) {
  Worst error;
  for (const double sine : {0.5, 1e-2, 1e-3, 3e-4, 1e-4, 1e-7}) {
    const Wide s2 = Wide{sine} * sine;
    const Wide truth = s2 / (1 + wide_sqrt(1 - s2));
    error.see(std::abs(static_cast<double>(one_minus_cos_from_sin2(sine * sine) / truth - 1)));
  }
  test::at_most("L2", "relative error of 1 - cos(half angle)", error.value(), 1e-12);
}

/// Returns the solid angle of a square as seen from the origin. The square has the side 2 h, and
/// its middle is (aside, 0) at height 1. The integral is computed by Gauss's rule of 5 x 5 points,
/// whose relative error is of the order of h^10.
Wide solid_angle(double h, double aside) {
  const double nodes[] = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                          -0.9061798459386640};
  const double weights[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                            0.2369268850561891, 0.2369268850561891};
  Wide sum = 0;
  for (int i = 0; i < 5; ++i) {
    for (int k = 0; k < 5; ++k) {
      const Wide x = aside + Wide{h} * nodes[i];
      const Wide y = Wide{h} * nodes[k];
      const Wide r2 = x * x + y * y + 1;
      sum += Wide{weights[i]} * weights[k] / (r2 * wide_sqrt(r2));
    }
  }
  return sum * h * h;
}

TEST(SphericalRectangle, L5_SmallRectanglesKeepTheirSolidAngle) {
  for (const double aside : {0.0, 3.0}) {
    Worst error;
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      const auto seen = SphericalRectangle::seen_from({0, 0, 0}, {aside - h, -h, 1}, {2 * h, 0, 0},
                                                      {0, 2 * h, 0});
      ASSERT_TRUE(seen);
      // The corners are rounded: the sum of aside - h and 2 h is not exactly aside + h. The error
      // includes the effect of this rounding.
      error.see(std::abs(static_cast<double>(seen->solid_angle() / solid_angle(h, aside) - 1)));
    }
    test::at_most("L5",
                  aside == 0
                      ? "relative error of solid angles of 4e-4 to 4e-8 sr straight ahead"
                      : "relative error of solid angles of quads 3 units to the side at height 1",
                  error.value(), 1e-11);
  }
}

TEST(PowerHeuristic, L10_NeitherOverflowsNorLosesEnergy) {
  Worst off;
  for (int i = -30; i <= 30; ++i) {
    for (int k = -30; k <= 30; ++k) {
      const double p = 1.3 * std::pow(10.0, i);
      const double q = 0.7 * std::pow(10.0, k);
      off.see(std::abs(power_heuristic(p, q) + power_heuristic(q, p) - 1));
    }
  }
  test::at_most("L10", "difference of the sum of both weights from 1, in units of u, never NaN",
                off.value() / kUnit, 2);
}

TEST(Sampler, C7_PixelsOfTheLargestImageHaveDifferentRandomNumbers) {
  Random random(1);
  std::set<Sample4> seen;
  std::set<std::pair<std::uint32_t, std::uint32_t>> pixels;
  while (pixels.size() < 100'000) {
    const std::uint32_t x = pixels.size() % 2 == 0 ? random.below(65536) : 65535 - random.below(64);
    pixels.insert({x, random.below(65536)});
  }
  for (const auto& [x, y] : pixels) {
    seen.insert(sample4({0, x, y, 0}, 0));
  }
  test::at_most("C7",
                "pixels whose random numbers equal those of another pixel, of 100,000 pixels in an "
                "image of 65,536 x 65,536",
                static_cast<double>(pixels.size() - seen.size()), 0);
}

// Expects that the mean over 2 x 2 pixels has a quarter of the variance of one pixel. If
// neighbouring pixels shared samples, the mean would have more variance.
TEST(Sampler, R3_NeighboursShareNoSamples) {
  constexpr std::uint32_t kSide = 512;
  test::Moments pixel;
  test::Moments block;
  for (std::uint32_t y = 0; y < kSide; y += 2) {
    for (std::uint32_t x = 0; x < kSide; x += 2) {
      double sum = 0;
      for (std::uint32_t i = 0; i < 4; ++i) {
        const PixelSampler sampler(0, x + i % 2, y + i / 2);
        double mean = 0;
        for (std::uint64_t s = 0; s < 4; ++s) {
          mean += sampler.group(s, 0)[0] / 4;
        }
        pixel.add(mean);
        sum += mean / 4;
      }
      block.add(sum);
    }
  }
  const double ratio = 4 * block.variance() / pixel.variance();
  test::at_most("R3",
                "variance of means of 2 x 2 pixels divided by a quarter of the variance of a "
                "pixel, difference from 1",
                std::abs(ratio - 1), 0.05);
}

// Each pixel shows a checkerboard. Each side of the pixel has `cells` cells, an odd number. The
// RMSE of independent samples is about 0.5 / sqrt(samples).
TEST(Sampler, R9_DetailFinerThanAPixelIsNoWorseThanWithIndependentSamples) {
  Worst ratio;
  for (const int cells : {3, 7, 13, 29, 101}) {
    for (const std::uint64_t samples : {16u, 64u, 256u}) {
      double squares = 0;
      constexpr std::uint32_t kPixels = 2000;
      for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
        const PixelSampler sampler(1, pixel, 3);
        int dark = 0;
        for (std::uint64_t s = 0; s < samples; ++s) {
          const Sample4 at = sampler.group(s, 0);
          dark += (static_cast<int>(at[0] * cells) + static_cast<int>(at[1] * cells)) % 2;
        }
        const double truth = (cells * cells - 1) / 2.0 / (cells * cells);
        const double error = dark / static_cast<double>(samples) - truth;
        squares += error * error / kPixels;
      }
      ratio.see(std::sqrt(squares) / (0.5 / std::sqrt(static_cast<double>(samples))));
    }
  }
  test::at_most("R9", "RMSE divided by the RMSE of independent samples", ratio.value(), 1.1);
}

// One pixel gets the sums of samples 0 to 16, 16 to 32, 32 to 64 and so on, up to 2^30 samples.
// The samples of a pixel are summed in a binary tree, and each of these sums belongs to a node of
// the tree. Each sum adds floats from [0, 2) in double.
TEST(Film, A1_LongSumsKeepTheirDigits) {
  auto film = Film::create(1, 1, "");
  ASSERT_TRUE(film.ok());
  Random random(2);
  std::uint64_t exact = 0;
  // run.sh uses the second number of tries, and the default tests use the first.
  const std::uint64_t samples = std::uint64_t{1} << tries(22, 30);
  for (SampleRange node{0, 16}; node.first < samples; node = {node.last, 2 * node.last}) {
    double sum = 0;
    for (std::uint64_t i = node.first; i < node.last; ++i) {
      const std::uint64_t units = random.bits() >> 40;
      sum += static_cast<float>(static_cast<double>(units) * 0x1p-23);
      exact += units;
    }
    ASSERT_TRUE(film->add({{node, {0, 1}}, 1, {sum, sum, sum}, {}}).ok());
  }
  const double mean = static_cast<double>(exact) / static_cast<double>(samples) * 0x1p-23;
  const Film::Snapshot snapshot = film->snapshot();
  EXPECT_EQ(snapshot.least_samples, samples);
  test::at_most("A1", "relative error of the mean of " + std::to_string(samples) + " samples",
                std::abs(snapshot.image.pixels[0].g / mean - 1), 1e-7);
}

/// Returns the error estimate of an image from the sums of its two halves. `a` and `b` have three
/// sums a pixel, each of `samples` samples.
ErrorEstimate estimate_of(const std::vector<double>& a, const std::vector<double>& b,
                          std::uint64_t samples) {
  ErrorSums sums;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    const NodeSums nodes[] = {{samples, absl::MakeConstSpan(a).subspan(i, 3)},
                              {samples, absl::MakeConstSpan(b).subspan(i, 3)}};
    sums.add(nodes);
  }
  sums.end_group();
  return sums.estimate();
}

TEST(ErrorEstimate, A2_ASmallSpreadAboutALargeValueIsAccurate) {
  const std::vector<double> a(30, 4096 * 100.01);
  const std::vector<double> b(30, 4096 * 99.99);
  test::at_most("A2", "relative error of the estimated RMSE, which is 0.01 at the value 100",
                std::abs(estimate_of(a, b, 4096).rmse / 0.01 - 1), 1e-6);
}

TEST(ErrorEstimate, A8_OneHugeSampleIsFiniteAndDoubtful) {
  std::vector<double> a(30'000, 16);
  const std::vector<double> b = a;
  a[999] = 1e30;
  const ErrorEstimate error = estimate_of(a, b, 16);
  EXPECT_TRUE(std::isfinite(error.rmse) && std::isfinite(error.relative_mse));
  EXPECT_TRUE(std::isfinite(error.percentile_99) && std::isfinite(error.worst_share));
  EXPECT_TRUE(error.doubtful());
  test::report_hard_case(
      "A8", "all numbers of the error estimate are finite; the estimate is marked as doubtful");
}

TEST(Srgb, P2P3_CodesAreRoundedAndTheCurveFollowsTheStandard) {
  Worst code_error;
  Worst curve_error;
  for (int i = 0; i <= 1'000'000; ++i) {
    const float x = static_cast<float>(i) * 1e-6f;
    const double curve = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(double{x}, 1 / 2.4) - 0.055;
    code_error.see(std::abs(srgb_encode(x) - 255 * curve));
    curve_error.see(std::abs(srgb_curve(x) - curve));
  }
  EXPECT_EQ(srgb_encode(0), 0);
  EXPECT_EQ(srgb_encode(1), 255);
  test::at_most("P2", "error of the codes of 1,000,001 values, in codes", code_error.value(),
                0.5 + 1e-6);
  test::at_most("P3", "error of the sRGB curve, in 16-bit codes", curve_error.value() * 65535, 0.5);
}

TEST(Exr, P4_HalfFloatsAreClampedAndNeverInfinite) {
  Image image;
  image.width = 4;
  image.height = 1;
  image.pixels = {{65'520, 1e30f, -1e30f}, {1e-8f, 0, 65'504}, {1, 2, 3}, {0.1f, 0.2f, 0.3f}};
  const auto bytes = encode_exr(image, true, {});
  ASSERT_TRUE(bytes.ok());
  const auto back = decode_exr({reinterpret_cast<const char*>(bytes->data()), bytes->size()});
  ASSERT_TRUE(back.ok()) << back.status();
  const auto value = [&](std::size_t i) {
    float v;
    std::memcpy(&v, back->texels.span().data() + 4 * i, 4);
    return v;
  };
  EXPECT_EQ(value(0), 65504);
  EXPECT_EQ(value(1), 65504);
  EXPECT_EQ(value(2), -65504);
  EXPECT_EQ(value(3), 0);
  EXPECT_EQ(value(5), 65504);
  EXPECT_EQ(beyond_half(image), 3u);
  test::report_hard_case("P4",
                         "values of 65,520 and more become 65,504 and are counted; 1e-8 becomes 0");
}

}  // namespace
}  // namespace bandsaw
