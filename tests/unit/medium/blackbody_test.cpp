// The colour and the luminance of the light that black bodies emit.

#include "renderlib/medium/blackbody.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bandsaw {
namespace {

/// CIE xy of a linear sRGB colour.
std::array<double, 2> chromaticity(const Rgb& c) {
  const double x = 0.4124 * c.r + 0.3576 * c.g + 0.1805 * c.b;
  const double y = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
  const double z = 0.0193 * c.r + 0.1192 * c.g + 0.9505 * c.b;
  return {x / (x + y + z), y / (x + y + z)};
}

// Chromaticities of the Planckian locus. 2856 K is the standard illuminant A (CIE 15:2004, table
// T.3). The other values are from Wyszecki and Stiles 1982, table 1(3.11).
TEST(Blackbody, HasTheChromaticityOfThePlanckianLocus) {
  struct Known {
    double kelvin;
    double x;
    double y;
  };
  for (const Known& known :
       {Known{2000, 0.5267, 0.4133}, Known{2856, 0.4476, 0.4074}, Known{4000, 0.3805, 0.3768},
        Known{6500, 0.3135, 0.3237}, Known{10000, 0.2807, 0.2884}}) {
    for (const BlackbodyScale scale : {BlackbodyScale::kPower, BlackbodyScale::kPeak}) {
      const auto [x, y] = chromaticity(blackbody(known.kelvin, scale));
      EXPECT_NEAR(x, known.x, 0.002) << known.kelvin;
      EXPECT_NEAR(y, known.y, 0.002) << known.kelvin;
    }
  }
}

// On the scale kPower, the luminance is (T / 1000 K)^4 / 1000. On the scale kPeak, the maximum of
// the spectrum is 1.
TEST(Blackbody, LuminanceIsThatOfTheScale) {
  for (const double kelvin : {150.0, 500.0, 1000.0, 1500.0, 3000.0, 20000.0, 2e5}) {
    EXPECT_NEAR(
        luminance(blackbody(kelvin, BlackbodyScale::kPower)) / (std::pow(kelvin / 1000, 4) / 1000),
        1, 1e-5)
        << kelvin;
  }
  // The spectrum is at most 1. At temperatures near 5200 K, it is about 1 in the whole visible
  // range.
  for (double kelvin = 1000; kelvin < 1e5; kelvin *= 1.1) {
    EXPECT_LE(luminance(blackbody(kelvin, BlackbodyScale::kPeak)), 1.0001f);
  }
  EXPECT_NEAR(luminance(blackbody(5200, BlackbodyScale::kPeak)), 0.98, 0.02);
}

TEST(Blackbody, IsBlackWhenColdAndRedWhenCool) {
  EXPECT_EQ(blackbody(0, BlackbodyScale::kPower), Rgb{});
  EXPECT_EQ(blackbody(99.9, BlackbodyScale::kPower), Rgb{});
  const Rgb red = blackbody(600, BlackbodyScale::kPower);
  EXPECT_GT(red.r, 0);
  EXPECT_EQ(red.g, 0);
  EXPECT_EQ(red.b, 0);
}

TEST(BlackbodyTable, IsNearTheFunction) {
  for (const BlackbodyScale scale : {BlackbodyScale::kPower, BlackbodyScale::kPeak}) {
    const BlackbodyTable table(scale);
    for (double kelvin = 1000; kelvin < 1e5; kelvin *= 1.0123) {
      const Rgb exact = blackbody(kelvin, scale);
      const float most = 0.002f * luminance(exact);
      const Rgb read = table.at(kelvin);
      EXPECT_NEAR(read.r, exact.r, most) << kelvin;
      EXPECT_NEAR(read.g, exact.g, most) << kelvin;
      EXPECT_NEAR(read.b, exact.b, most) << kelvin;
    }
    EXPECT_EQ(table.at(50), Rgb{});
    EXPECT_EQ(table.at(1e9), table.at(131072));
    EXPECT_EQ(table.at(-5), Rgb{});
  }
}

}  // namespace
}  // namespace bandsaw
