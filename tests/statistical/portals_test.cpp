// Tests that sampling the background through portals changes no expected value. A portal is a
// rectangle through which light sampling aims at the background. The scene is a floor under a sky.
// The portals cover a part of the sky, and the radiance of the floor is known.

#include "renderlib/guiding/portals.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/environments.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

constexpr Ray kDown = {.origin = {0, 1, 0}, .direction = {0.6, -0.8, 0}};

/// A floor of reflectance 1/2 under the sky.
test::SceneMaker floor_under_sky() {
  test::SceneMaker maker;
  maker.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}, maker.diffuse(0.5f));
  return maker;
}

/// Expects that each technique measures the radiance `radiance` along kDown, within 4 standard
/// errors plus 1e-3 of `radiance`.
void expect_radiance(const Scene& scene, const Portals& portals, double radiance) {
  for (const Technique technique :
       {Technique::kBoth, Technique::kLightsOnly, Technique::kScatteringOnly}) {
    const test::Moments measured = test::radiance_along(
        scene, kDown, {.max_depth = 2, .technique = technique, .portals = &portals}, 4096);
    EXPECT_NEAR(measured.mean(), radiance, 4 * measured.standard_error() + 1e-3 * radiance)
        << static_cast<int>(technique);
  }
}

/// Returns two portals above the floor, and one portal far to the side. Seen from the middle of the
/// floor, the two portals above the floor overlap.
const Portals& some_portals() {
  static const Portals portals({{{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}},
                                {{0, 3, 0}, {4, 0, 0}, {0, 0, 4}},
                                {{5, 0.5, -1}, {0, 2, 0}, {0, 0, 2}}});
  return portals;
}

TEST(PortalsInScenes, TheRadianceUnderAUniformSkyIsThatOfTheClosedForm) {
  test::SceneMaker maker = floor_under_sky();
  maker.background({2, 2, 2}, {2, 2, 2});
  expect_radiance(*maker.build(), some_portals(), 1);
}

TEST(PortalsInScenes, AGradientHasItsClosedForm) {
  // In direction d the sky has (1 + d.y) / 2 times the radiance 3 of its top. The cosine-weighted
  // mean of d.y is 2/3, and the floor reflects 1/2.
  test::SceneMaker maker = floor_under_sky();
  maker.background({0, 0, 0}, {3, 3, 3});
  expect_radiance(*maker.build(), some_portals(), 0.5 * 3 * (1 + 2.0 / 3) / 2);
}

TEST(PortalsInScenes, AnEnvironmentHasTheSameMeanWithAndWithoutPortals) {
  // One texel of the upper half is much brighter than the others. It is seen through a portal.
  test::SceneMaker maker = floor_under_sky();
  maker.scene.background.environment = Environment{
      .images = {maker.texture({test::float_image(16, 8, [](std::uint32_t x, std::uint32_t y) {
        return x == 5 && y == 1 ? 50.0f : 1.0f;
      })})}};
  const auto scene = maker.build();
  const test::Moments without = test::radiance_along(*scene, kDown, {.max_depth = 2}, 4096);
  EXPECT_GT(without.mean(), 0.6);
  expect_radiance(*scene, some_portals(), without.mean());
}

}  // namespace
}  // namespace bandsaw
