// Portals: rectangles through which the background is sampled, uniformly by solid angle.

#include "renderlib/guiding/portals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderlib/math/constants.h"
#include "tests/support/direction_test.h"

namespace bandsaw {
namespace {

/// A window of 3 x 2 in the wall x = 1.
constexpr Portal kWindow = {{1, -1.5, -0.5}, {0, 3, 0}, {0, 0, 2}};
/// A second window in the wall z = 2, and a third one that overlaps with the first as seen from the
/// origin.
constexpr Portal kSkylight = {{-2, -1, 2}, {3, 0, 0}, {0, 3, 0}};
constexpr Portal kFarther = {{2, 0, 0}, {0, 4, 0}, {0, 0, 3}};

TEST(Portals, SamplesDirectionsWithTheClaimedPdf) {
  std::uint64_t seed = 70;
  const std::vector<std::vector<Portal>> sets = {
      {kWindow}, {kWindow, kSkylight}, {kWindow, kSkylight, kFarther}};
  for (const std::vector<Portal>& set : sets) {
    const Portals portals(set);
    // Portals::sample() takes three random numbers, but the test gives two. So the first 20 bits of
    // `u` choose the portal, and the other bits of `u` are the u of the sample.
    test::expect_samples_match_density(
        [&](double u, double v) {
          const double steps = u * 0x1p20;
          const auto sample =
              portals.sample({}, std::floor(steps) * 0x1p-20, steps - std::floor(steps), v);
          EXPECT_TRUE(sample);
          EXPECT_NEAR(length(sample->direction), 1, 1e-14);
          EXPECT_GT(sample->pdf, 0);
          return sample->direction;
        },
        [&](const Vec3& d) { return portals.pdf({}, d); }, ++seed, sets.size());
  }
}

TEST(Portals, SamplesHaveThePdfOfTheirDirection) {
  const Portals portals({kWindow, kSkylight, kFarther});
  for (int i = 0; i < 1000; ++i) {
    const double choice = (i + 0.5) / 1000;
    const double u = std::fmod(i * 0.6180339887, 1.0);
    const double v = std::fmod(i * 0.7548776662, 1.0);
    const auto sample = portals.sample({0.5, 0.25, 0}, choice, u, v);
    ASSERT_TRUE(sample);
    EXPECT_DOUBLE_EQ(sample->pdf, portals.pdf({0.5, 0.25, 0}, sample->direction)) << i;
  }
}

TEST(Portals, PdfOfACubeFaceIsTheClosedForm) {
  // A face of a cube around the point is a sixth of all directions.
  const Portals face(std::vector<Portal>{{{1, -1, -1}, {0, 2, 0}, {0, 0, 2}}});
  EXPECT_NEAR(face.pdf({}, {1, 0, 0}), 6 / (4 * kPi), 1e-12);
  EXPECT_EQ(face.pdf({}, {-1, 0, 0}), 0);
  EXPECT_EQ(face.pdf({}, {0, 1, 0}), 0);
}

TEST(Portals, AreNotSampledFromTheirOwnPlaneOrIfThereAreNone) {
  EXPECT_FALSE(Portals().sample({}, 0.5, 0.5, 0.5));
  EXPECT_EQ(Portals().pdf({}, {1, 0, 0}), 0);
  const Portals window(std::vector<Portal>{kWindow});
  EXPECT_FALSE(window.sample({1, 5, 5}, 0.5, 0.5, 0.5));
  EXPECT_EQ(window.pdf({1, 5, 5}, {0, -1, 0}), 0);
}

}  // namespace
}  // namespace bandsaw
