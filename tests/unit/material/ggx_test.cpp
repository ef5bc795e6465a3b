// The GGX distribution of microfacets: its samples, weights and table of albedos. An id such as M3
// in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/material/ggx.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx_albedo.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Random;
using test::Wide;

/// Returns a unit direction whose cosine to the normal, +z, is mu.
Vec3 at_cosine(double mu) { return {std::sqrt(1 - mu * mu), 0, mu}; }

TEST(Ggx, M3TheDistributionIsExactHoweverSmoothTheSurface) {
  Random random(3);
  for (const double alpha : {0.5, 0.1, 0.01, 1e-3, 1e-4}) {
    for (int i = 0; i < 1000; ++i) {
      const double angle = random.uniform(0, 4 * alpha);
      const Vec3 h{std::sin(angle), 0, std::cos(angle)};
      const Wide a2 = Wide{alpha} * Wide{alpha};
      const Wide t = Wide{h.x} * Wide{h.x} / a2 + Wide{h.z} * Wide{h.z};
      const auto truth = static_cast<double>(1 / (Wide{kPi} * a2 * t * t));
      ASSERT_NEAR(ggx_distribution(h, alpha) / truth, 1, 1e-13);
    }
  }
  test::report_hard_case(
      "M3", "5,000 values of D within 1e-13 (relative) of values computed with 113-bit numbers");
}

// The density must integrate to 1 over all facets (the weak white furnace test), because the areas
// of the visible facets, as seen from o, sum to the area of the surface.
TEST(Ggx, VisibleNormalsAreSampledWithTheirDensity) {
  for (const double alpha : {0.35, 0.6, 1.0}) {
    for (const double mu : {0.1, 0.4, 1.0}) {
      const Vec3 o = at_cosine(mu);
      test::expect_samples_match_density(
          [&](double u, double v) { return sample_ggx_visible(o, alpha, u, v); },
          [&](const Vec3& h) {
            return h.z <= 0 ? 0 : ggx_visible_over_cos(o, h, alpha) * std::max(0.0, dot(o, h));
          },
          /*seed=*/static_cast<std::uint64_t>(alpha * 100 + mu * 10), /*tests=*/9);
    }
  }
}

TEST(Ggx, M5WeightsOfVisibleNormalsStayInTheUnitIntervalEvenAtGrazingDirections) {
  Random random(5);
  for (const double alpha : {1e-4, 0.01, 0.3, 1.0}) {
    for (const double mu : {0.0, 1e-12, 1e-4, 0.5, 1.0}) {
      for (int n = 0; n < 2000; ++n) {
        const double u = random.uniform();
        const Vec3 h = sample_ggx_visible(at_cosine(mu), alpha, u, random.uniform());
        ASSERT_NEAR(length(h), 1, 1e-12);
        const Vec3 i = mirrored(at_cosine(mu), h);
        const double weight = ggx_shadowing(at_cosine(mu), i, alpha);
        ASSERT_TRUE(weight >= 0 && weight <= 1 + 1e-9) << alpha << " " << mu;
        ASSERT_TRUE(std::isfinite(ggx_visible_over_cos(at_cosine(mu), h, alpha)));
      }
    }
  }
  test::report_hard_case("M5", "40,000 weights in [0, 1 + 1e-9]");
}

// The expected values are the albedos of single scattering if the Fresnel reflectance is 1. They
// were computed by quadrature in another program. At alpha 1 and normal incidence the closed form
// is 1 - ln 2.
TEST(Ggx, TheAlbedoTableHoldsTheIntegrals) {
  struct Known {
    double alpha;
    double mu;
    double albedo;
  };
  for (const Known& k :
       {Known{0.1, 0.05, 0.91176}, Known{0.1, 0.2, 0.90456}, Known{0.1, 0.5, 0.96920},
        Known{0.1, 1, 0.98831}, Known{0.5, 0.05, 0.91255}, Known{0.5, 0.2, 0.78993},
        Known{0.5, 0.5, 0.69825}, Known{0.5, 1, 0.68785}, Known{1, 0.05, 0.84777},
        Known{1, 0.2, 0.64165}, Known{1, 0.5, 0.45069}, Known{1, 1, 0.30685}}) {
    EXPECT_NEAR(ggx_albedo_table().at(k.mu, std::sqrt(k.alpha)).white, k.albedo, 2e-3)
        << k.alpha << " " << k.mu;
    double sum = 0;
    constexpr int kSide = 400;
    for (int a = 0; a < kSide; ++a) {
      for (int b = 0; b < kSide; ++b) {
        const Vec3 o = at_cosine(k.mu);
        const Vec3 h = sample_ggx_visible(o, k.alpha, (a + 0.5) / kSide, (b + 0.5) / kSide);
        const Vec3 i = mirrored(o, h);
        sum += i.z > 0 ? ggx_shadowing(o, i, k.alpha) : 0;
      }
    }
    EXPECT_NEAR(sum / (kSide * kSide), k.albedo, 5e-4) << k.alpha << " " << k.mu;
  }
}

}  // namespace
}  // namespace bandsaw
