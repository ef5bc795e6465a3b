// Tests media whose boundaries are in groups, are placed by instances, and move. Each test compares
// the lengths of rays inside the medium with the expected lengths.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/import/import.h"
#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/scene/scene.h"
#include "tests/unit/import/files.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

constexpr double kDensity = 0.25;  // absorption of the smoke per unit of length
const std::string kHead = R"(
material { name: "glass" dielectric { } }
material { name: "white" diffuse { color { rgb: [1, 1, 1] } } }
medium { name: "smoke" absorption { rgb: [0.25, 0.25, 0.25] } }
medium { name: "air" }
)";
/// A camera whose shutter is open from time 0 to time 1.
const std::string kOpenFor1 =
    "camera { position: [0, 1, 5] look_at: [0, 0, 0] shutter_open: 0 shutter_close: 1 }\n";

/// Imports a scene file of kHead and `text`. Its folder also has cube.obj, a unit cube.
absl::StatusOr<ImportedScene> import_text(const std::string& text) {
  const TempDir folder;
  write_text(folder, "cube.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
             "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n");
  return import_scene(write_text(folder, "s.textproto", kHead + text));
}

/// Builds the scene of a scene file, which consists of kHead and `text`.
std::shared_ptr<const Scene> scene_of(const std::string& text) {
  auto imported = import_text(text);
  EXPECT_TRUE(imported.ok()) << imported.status();
  Pool pool(1);
  auto scene = Scene::build(std::move(imported->scene), pool);
  EXPECT_TRUE(scene.ok()) << scene.status();
  return *scene;
}

/// Returns the length of the part of a ray that is inside the smoke. The ray begins outside.
double smoke_along(const Scene& scene, const Vec3& origin, const Vec3& direction, double time = 0) {
  std::uint64_t rays = 0;
  const Ray ray{.origin = origin, .direction = direction, .time = time};
  return -std::log(double{media_transmittance(scene, ray, NumberStream(0), rays).g}) / kDensity;
}

constexpr double kError = 4e-6;  // tolerance of a length, because the transmittance is a float

TEST(PlacedMedia, TheDensityDoesNotDependOnThePlacement) {
  const auto scene = scene_of(kOpenFor1 + R"(
group { name: "box"  shape { box { min: [0, 0, 0] max: [1, 2, 3] } interior: "smoke" } }
group { name: "turned"  instance { of: "box"  rotate { axis: [0, 1, 0] degrees: 90 } } }
instance { of: "box"  scale: 2  translate: [10, 0, 0] }
instance { of: "box"  scale: [-4, 1, 1]  translate: [10, 10, 0]  material: "glass" }
instance { of: "turned"  scale: [1, 1, -5]  translate: [10, 20, 0] }
)");
  // The instances are a box of 2 x 4 x 6 at (10, 0, 0), a mirrored box of 4 x 2 x 3 at
  // (10, 10, 0), and a rotated and mirrored box of 3 x 2 x 5 at (10, 20, 0).
  EXPECT_NEAR(smoke_along(*scene, {0, 1, 1}, {1, 0, 0}), 2, kError);
  EXPECT_NEAR(smoke_along(*scene, {11, -9, 1}, {0, 1, 0}), 4 + 2, kError);
  EXPECT_NEAR(smoke_along(*scene, {11, 1, -9}, {0, 0, 1}), 6, kError);
  EXPECT_NEAR(smoke_along(*scene, {0, 11, 1}, {1, 0, 0}), 4, kError);
  EXPECT_NEAR(smoke_along(*scene, {8, 11, -9}, {0, 0, 2}), 3, kError);
  EXPECT_NEAR(smoke_along(*scene, {0, 21, 1}, {1, 0, 0}), 3, kError);
  EXPECT_NEAR(smoke_along(*scene, {11, 21, -9}, {0, 0, 1}), 5, kError);
  EXPECT_TRUE(scene->geometry().instances.empty());
  EXPECT_FALSE(scene->features().motion);
}

TEST(PlacedMedia, ABallInAGroupFillsTheVisibleEllipsoid) {
  const auto scene = scene_of(kOpenFor1 + R"(
group { name: "ball"  shape { sphere { center: [1, 0, 0] radius: 0.5 } material: "glass" interior: "smoke" } }
instance { of: "ball"  scale: [3, 1, -1] }
)");
  EXPECT_NEAR(smoke_along(*scene, {-9, 0, 0}, {1, 0, 0}), 3, kError);
  EXPECT_NEAR(smoke_along(*scene, {3, 9, 0}, {0, -1, 0}), 1, kError);
  EXPECT_NEAR(smoke_along(*scene, {3.9, 9, 0}, {0, -1, 0}), std::sqrt(1 - 0.36), kError);
  EXPECT_EQ(scene->geometry().groups.at(0).spheres.size(), 1u);
}

TEST(PlacedMedia, AModelInAGroupFillsItsMeshes) {
  const auto scene = scene_of(kOpenFor1 + R"(
group { name: "cube"  model { file: "cube.obj" interior: "smoke" boundary_only: true scale: [1, 1, 2] } }
group { name: "hole"  shape { sphere { radius: 0.25 } interior: "air" } }
instance { of: "cube"  scale: [-3, 3, 3] }
instance { of: "hole"  translate: [-1, 1, 1] }
)");
  EXPECT_NEAR(smoke_along(*scene, {-1, 2, -9}, {0, 0, 1}), 6, kError);
  EXPECT_NEAR(smoke_along(*scene, {-9, 2, 1}, {1, 0, 0}), 3, kError);
  EXPECT_NEAR(smoke_along(*scene, {-9, 1, 1}, {1, 0, 0}), 3 - 0.5, kError);
}

TEST(PlacedMedia, ABoundaryWithAVelocityMovesTheMedium) {
  const std::string shapes = R"(
shape { box { min: [-1, -1, -1] max: [1, 1, 1] } interior: "smoke" velocity: [0, 2, 0] }
shape { sphere { center: [9, 0, 0] radius: 1 } interior: "smoke" velocity: [0, -2, 0] }
)";
  const auto scene = scene_of(kOpenFor1 + shapes);
  EXPECT_TRUE(scene->features().motion);
  // The box reaches the first ray, at y = 2, at the time 0.5. The centre of the ball is at
  // y = -2 time, and the second ray is at y = -0.5.
  for (const double time : {0.0, 0.2, 0.499, 0.501, 1.0}) {
    EXPECT_NEAR(smoke_along(*scene, {0, 2, -9}, {0, 0, 1}, time), time > 0.5 ? 2 : 0, kError);
    const double aside = -0.5 + 2 * time;
    const double chord = std::abs(aside) < 1 ? 2 * std::sqrt(1 - aside * aside) : 0;
    EXPECT_NEAR(smoke_along(*scene, {9, -0.5, -9}, {0, 0, 1}, time), chord, kError) << time;
  }
  // If the shutter has no duration, nothing moves. Each shape is where it is at the time 0.75.
  const auto moment = scene_of(
      "camera { position: [0, 1, 5] look_at: [0, 0, 0] shutter_open: 0.75 shutter_close: 0.75 }" +
      shapes);
  EXPECT_FALSE(moment->features().motion);
  EXPECT_NEAR(smoke_along(*moment, {0, 2, -9}, {0, 0, 1}), 2, kError);
  EXPECT_NEAR(smoke_along(*moment, {9, -1.5, -9}, {0, 0, 1}), 2, kError);
}

TEST(PlacedMedia, ABoundaryPlacedByKeysScalesAndMovesTheMedium) {
  const auto scene = scene_of(kOpenFor1 + R"(
group {
  name: "pair"
  shape { box { min: [0, 0, 0] max: [1, 1, 1] } interior: "smoke" velocity: [0, 0, 1] }
  model { file: "cube.obj" material: "white" interior: "smoke"
    key { time: 0 translate: [4, 0, 0] } key { time: 1 translate: [6, 0, 0] } }
}
instance { of: "pair"  key { time: 0 scale: 1 } key { time: 1 scale: [3, 3, 3] } }
)");
  for (const double time : {0.0, 0.3, 1.0}) {
    // In the coordinates of the group, the first ray is at z = time + 0.5. It passes the box, which
    // moves along z, at all times. It passes the cube, which ends at z = 1, until the time 0.5.
    const double scale = 1 + 2 * time;
    const double z = (time + 0.5) * scale;
    EXPECT_NEAR(smoke_along(*scene, {-9, 0.5, z}, {1, 0, 0}, time), scale * (time > 0.5 ? 1 : 2),
                kError)
        << time;
    EXPECT_NEAR(smoke_along(*scene, {scale * (4.5 + 2 * time), 9, 0.1}, {0, -1, 0}, time), scale,
                kError);
  }
}

TEST(PlacedMedia, AGroupThatIsNotPlacedHasNoMedium) {
  const auto scene = scene_of(kOpenFor1 + R"(
group { name: "box"  shape { box { min: [0, 0, 0] max: [1, 2, 3] } interior: "smoke" } }
shape { sphere { radius: 1 } material: "white" }
)");
  EXPECT_FALSE(scene->features().media);
}

TEST(PlacedMedia, APlacementThatIsTooSmallIsRefused) {
  EXPECT_THAT(std::string(import_text(kOpenFor1 + R"(
group { name: "box"  shape { box { min: [0, 0, 0] max: [1, 1, 1] } interior: "smoke" } }
group { name: "small"  instance { of: "box"  scale: 1e-200 } }
instance { of: "small"  scale: 1e-200 }
)")
                              .status()
                              .message()),
              HasSubstr("instance[0].scale: is too large or too small for what is placed"));
}

}  // namespace
}  // namespace bandsaw
