// The Henyey-Greenstein phase function: samples, pdf and mean cosine. An id such as V5 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/medium/phase.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/medium/medium.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

TEST(Phase, PdfMatchesItsSamples) {
  const std::vector<double> gs = {-0.9, -0.3, -1e-5, 0, 1e-5, 0.3, 0.9};
  const Vec3 direction = normalize({0.3, -0.8, 0.4});
  for (std::size_t i = 0; i < gs.size(); ++i) {
    SCOPED_TRACE(gs[i]);
    test::expect_samples_match_density(
        [&](double u, double v) { return sample_phase(gs[i], direction, u, v); },
        [&](const Vec3& d) { return phase(gs[i], dot(direction, d)); }, 20 + i, gs.size());
  }
}

/// For |g| up to kMaxG, the directions have length 1, their pdf is positive, and the mean of the
/// cosine is g.
TEST(Phase, V5_MeanCosineIsG) {
  const Vec3 direction = normalize({-0.2, 0.1, -0.9});
  for (const double g : {-kMaxG, -0.9, -0.5, 0.0, 1e-4, 0.5, 0.9, kMaxG}) {
    // u takes the midpoints of equal parts of [0, 1), so the mean is a quadrature, not a random
    // estimate.
    constexpr int kParts = 20000;
    double sum = 0;
    for (int i = 0; i < kParts; ++i) {
      const Vec3 d = sample_phase(g, direction, (i + 0.5) / kParts, 0.3);
      ASSERT_NEAR(length(d), 1, 1e-14);
      ASSERT_GT(phase(g, dot(direction, d)), 0);
      sum += dot(direction, d);
    }
    EXPECT_NEAR(sum / kParts, g, 1e-3) << g;
  }
  test::report_hard_case("V5", "mean cosine within 1e-3 of g, up to the largest g");
}

/// Near g = 0 the cosine is accurate to rounding. u = 0 gives the cosine -1, and the largest u
/// gives the cosine 1.
TEST(Phase, V4_IsAccurateNearIsotropic) {
  const Vec3 up{0, 0, 1};
  test::Random random(4);
  for (const double g : {1e-2, -1e-3, 1e-4, -1e-5, 1e-12, 0.0}) {
    for (int i = 0; i < 2000; ++i) {
      const double u = random.uniform();
      const double cosine = sample_phase(g, up, u, 0.1).z;
      // The cumulative distribution of the cosine must be u. It is computed here by a series of
      // Legendre polynomials up to g^2.
      const double c = cosine;
      const double series = 0.5 * (1 + c) + (0.75 * g + 1.25 * g * g * c) * (c * c - 1);
      EXPECT_NEAR(series, u, 2 * std::abs(g * g * g) + 1e-14) << g;
    }
    EXPECT_NEAR(sample_phase(g, up, 0, 0.1).z, -1, 1e-15);
    EXPECT_NEAR(sample_phase(g, up, 1 - 0x1p-32, 0.1).z, 1, 1e-8);
  }
  test::report_hard_case("V4", "distribution of the cosine within 1e-14 + 2 g^3");
}

}  // namespace
}  // namespace bandsaw
