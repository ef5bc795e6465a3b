// Transmittance and emission of homogeneous media, also of very thin and very dense media. reach()
// is the integral of the transmittance over a segment, called the effective length. An id such as
// V1 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/medium/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/constants.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

/// Small extinctions keep their precision, and without extinction all light passes.
TEST(Attenuation, V1_TransmittanceIsExactForLittleExtinctionAndOneWithoutExtinction) {
  EXPECT_EQ(transmittance(0, 1), 1);
  EXPECT_EQ(transmittance(0, kInfinity), 1);
  EXPECT_EQ(reach(0, 7), 7);
  EXPECT_EQ(reach(0, kInfinity), kInfinity);
  for (const double sigma : {1e-30, 1e-15, 1e-8, 1e-3, 1.0, 30.0}) {
    for (const double length : {1e-5, 1.0, 100.0}) {
      const double depth = sigma * length;
      EXPECT_NEAR(transmittance(sigma, length), std::exp(-depth), 1e-12 * std::exp(-depth));
      const double expected = -std::expm1(-depth) / sigma;
      EXPECT_NEAR(reach(sigma, length), expected, 1e-12 * expected);
    }
  }
  test::report_hard_case("V1", "T = 1 for extinction 0; relative error of T within 1e-12");
}

/// Very dense media are opaque, and no number overflows in the computation.
TEST(Attenuation, V3_TransmittanceIsZeroForVeryDenseMedia) {
  for (const double sigma : {1e6, 1e12, 2e12}) {
    EXPECT_EQ(transmittance(sigma, kInfinity), 0);
    EXPECT_EQ(transmittance(sigma, 1e30), 0);
    EXPECT_EQ(reach(sigma, kInfinity), 1 / sigma);
  }
  EXPECT_EQ(transmittance(1e-30, kInfinity), 0);
}

TEST(Attenuation, IsComputedByChannel) {
  const Medium medium{.absorption = {0.5f, 0, 1}, .scattering = {0.5f, 0, 2}};
  const Rgb share = transmittance(medium, 2);
  EXPECT_FLOAT_EQ(share.r, std::exp(-2.0f));
  EXPECT_EQ(share.g, 1);
  EXPECT_FLOAT_EQ(share.b, std::exp(-6.0f));
}

TEST(Attenuation, OwnRadianceIsEmissionTimesEffectiveLength) {
  const Medium medium{.absorption = {0.5f, 0, 2}, .emission = {1, 3, 4}};
  const Rgb along = own_radiance(medium, 2);
  EXPECT_FLOAT_EQ(along.r, (1 - std::exp(-1.0f)) / 0.5f);
  EXPECT_EQ(along.g, 6);
  EXPECT_FLOAT_EQ(along.b, 2 * (1 - std::exp(-4.0f)));
  EXPECT_FLOAT_EQ(own_radiance({.absorption = {2, 2, 2}, .emission = {3, 3, 3}}, kInfinity).g,
                  1.5f);
  EXPECT_TRUE(is_black(own_radiance({}, kInfinity)));
}

}  // namespace
}  // namespace bandsaw
