// Compares Fresnel reflectances and refracted directions with tables and closed forms.

#include "renderlib/material/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bandsaw {
namespace {

TEST(Fresnel, HasTheValuesOfTheTables) {
  EXPECT_NEAR(fresnel(1, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel(0.5, 1.5), 0.0891867128, 1e-10);
  EXPECT_NEAR(fresnel(0.1, 1.5), 0.5715925203, 1e-10);
  EXPECT_NEAR(fresnel(0.01, 1.5), 0.9437525435, 1e-10);
  EXPECT_EQ(fresnel(0, 1.5), 1);
}

// The second argument of fresnel() is the relative index of refraction, which is below 1 for light
// from the denser side. The means are weighted by the cosine. Let s be the mean from the thinner
// side, r the mean from the denser side, and n the index above 1. Then 1 - r = (1 - s) / n^2.
TEST(Fresnel, HasTheKnownMeansOverTheHemisphereFromBothSides) {
  const auto mean = [](double eta) {
    constexpr int kSteps = 400000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double cosine = (i + 0.5) / kSteps;
      sum += 2 * cosine * fresnel(cosine, eta) / kSteps;
    }
    return sum;
  };
  EXPECT_NEAR(mean(1.5), 0.0917779594, 1e-8);
  EXPECT_NEAR(mean(1 / 1.5), 0.5963457598, 1e-7);
  EXPECT_NEAR(mean(1.33), 0.0659308493, 1e-8);
  EXPECT_NEAR(mean(2.4), 0.2101813020, 1e-8);
  EXPECT_NEAR(1 - mean(1 / 2.4), (1 - mean(2.4)) / (2.4 * 2.4), 1e-7);
}

TEST(Fresnel, EqualMediaReflectNothing) {
  for (const double cosine : {1.0, 0.5, 1e-3, 1e-9}) {
    EXPECT_NEAR(fresnel(cosine, 1), 0, 1e-15);
  }
}

TEST(Fresnel, ReflectionIsTotalBelowTheCriticalCosineAndContinuousAbove) {
  const double eta = 1 / 1.5;
  const double critical = std::sqrt(1 - eta * eta);
  for (int k = 3; k <= 14; ++k) {
    const double step = std::pow(10.0, -k);
    EXPECT_EQ(fresnel(critical - step, eta), 1);
    const double above = fresnel(critical + step, eta);
    EXPECT_LT(above, 1);
    // Near the critical cosine, 1 minus the reflectance grows like the square root of the distance.
    EXPECT_GT(above, 1 - 12 * std::sqrt(step));
  }
}

TEST(Fresnel, RefractionObeysSnellsLawAndIsReversible) {
  const Vec3 n{0, 0, 1};
  for (double angle = 0.01; angle < 1.57; angle += 0.05) {
    const Vec3 w{std::sin(angle), 0, std::cos(angle)};
    const auto cos_t = refracted_cos(w.z, 1.5);
    ASSERT_TRUE(cos_t);
    const Vec3 t = refracted(w, n, *cos_t, 1.5);
    EXPECT_NEAR(length(t), 1, 1e-12);
    EXPECT_LT(t.z, 0);
    EXPECT_NEAR(-t.x * 1.5, w.x, 1e-14);
    const auto back_cos = refracted_cos(-t.z, 1 / 1.5);
    ASSERT_TRUE(back_cos);
    EXPECT_NEAR(length(refracted(t, -n, *back_cos, 1 / 1.5) - w), 0, 1e-12);
  }
}

}  // namespace
}  // namespace bandsaw
