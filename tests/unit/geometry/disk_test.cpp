// Disks: their axes, boxes, intersections and surface points.

#include "renderlib/geometry/disk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/geometry/surface.h"
#include "tests/support/meshes.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Random;
using test::Wide;
using test::WideVec;

/// Returns a disk with a radius from 1e-3 to 1e3, near the origin or far from it.
Disk random_disk(Random& random) {
  return {std::pow(10, random.uniform(-2, 4)) * test::random_point(random),
          test::random_direction(random),
          std::pow(10, random.uniform(-3, 3)),
          {}};
}

TEST(Disk, ADiskThatFacesUpHasAxesAlongXAndMinusZ) {
  const DiskAxes axes = axes_of({{0, 0, 0}, {0, 1, 0}, 1, {}});
  EXPECT_EQ(axes.u, (Vec3{1, 0, 0}));
  EXPECT_EQ(axes.v, (Vec3{0, 0, -1}));
  // For every disk, u, v and the normal are right-handed.
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Disk disk = random_disk(random);
    const DiskAxes a = axes_of(disk);
    EXPECT_LE(length(cross(a.u, a.v) - disk.normal), 1e-15);
    EXPECT_NEAR(length(a.u), 1, 1e-15);
  }
}

// The normal is nearly along an axis, as in exported files. The box still contains the rim.
TEST(Disk, IsNotClippedByItsBoxIfTheNormalIsNearlyAlongAnAxis) {
  for (const double tilt : {1e-9, 1e-8, 4.371139e-8, 1e-7, 1e-6, 1e-3}) {
    const Disk disk{{0, 4, 0}, normalize(Vec3{tilt, -1, 0}), 1, {}};
    const Box box = bounds(disk);
    const DiskAxes axes = axes_of(disk);
    for (int i = 0; i < 100; ++i) {
      const double turn = 2 * kPi * i / 100;
      const Vec3 rim = disk.center + std::cos(turn) * axes.u + std::sin(turn) * axes.v;
      EXPECT_TRUE(rim.y >= box.lo.y && rim.y <= box.hi.y) << tilt;
      EXPECT_TRUE(rim.x >= box.lo.x && rim.x <= box.hi.x) << tilt;
    }
  }
}

// A hit is within the rim and on the ray. Except close to the rim, the function reports a hit
// exactly if the ray hits the disk.
TEST(Disk, IsHitWithinItsRim) {
  Random random(2);
  int hits = 0;
  int misses = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Disk disk = random_disk(random);
    const DiskAxes axes = axes_of(disk);
    const double distance_in_radii = random.uniform(0.5, 1.5);
    const double turn = random.uniform(0, 2 * kPi);
    const Vec3 target = disk.center + disk.radius * distance_in_radii *
                                          (std::cos(turn) * axes.u + std::sin(turn) * axes.v);
    const Vec3 origin = disk.center + disk.radius * 10 * test::random_point(random);
    const TracedRay ray = trace_setup(origin, target - origin, kInfinity);
    Crossing c;
    const bool hit = intersect(ray, disk, c);
    // The expected hit is computed in higher precision.
    const WideVec o(origin);
    const WideVec d = WideVec(target - origin);
    const WideVec n(disk.normal);
    const WideVec center(disk.center);
    const Wide slope = dot(d, n);
    if (std::abs(static_cast<double>(slope)) < 1e-6 * length(target - origin)) {
      continue;  // the ray is nearly in the plane of the disk
    }
    const Wide t = dot(center - o, n) / slope;
    const WideVec p = o + d * t - center;
    // Negative inside the rim, positive outside.
    const double out = static_cast<double>(dot(p, p)) / (disk.radius * disk.radius) - 1;
    // Allowance for rounding errors, which grow with the distance of the disk from the origin.
    const double slack = 1e-9 * (1 + max_abs(disk.center) / disk.radius);
    if (t <= 0 || std::abs(out) < slack) {
      continue;
    }
    ASSERT_EQ(hit, out < 0) << i << " " << out;
    hits += hit ? 1 : 0;
    misses += hit ? 0 : 1;
    if (hit) {
      ASSERT_NEAR(c.t, static_cast<double>(t), 1e-8 * (1 + max_abs(disk.center) / disk.radius));
      ASSERT_LE(c.u * c.u + c.v * c.v, 1 + slack);
    }
  }
  EXPECT_GT(hits, 50'000);
  EXPECT_GT(misses, 50'000);
}

TEST(Disk, IsMissedByRaysInItsPlaneAndRaysThatDoNotReachIt) {
  const Disk disk = {{1, 2, 3}, {0, 1, 0}, 2, {}};
  Crossing c;
  EXPECT_FALSE(intersect(trace_setup({-5, 2, 3}, {1, 0, 0}, kInfinity), disk, c));
  EXPECT_FALSE(intersect(trace_setup({1, 2, 3}, {0, 1, 0}, kInfinity), disk, c))
      << "the ray starts on the disk";
  EXPECT_FALSE(intersect(trace_setup({1, 4, 3}, {0, -1, 0}, 1), disk, c))
      << "the ray ends before the disk";
  EXPECT_TRUE(intersect(trace_setup({1, 4, 3}, {0, -1, 0}, 3), disk, c));
  EXPECT_EQ(c.t, 2);
}

// The point is at 0.25 radii along the axis u and 0.5 radii along the axis v. The uv are
// these two numbers, mapped from [-1, 1] to [0, 1].
TEST(Disk, SurfacePointsLieInThePlaneWithTheirUv) {
  Geometry g;
  g.disks.push_back({{1, 2, 3}, {0, 1, 0}, 2, MaterialId{7}});
  const Ray ray{{1.5, 5, 2}, {0, -1, 0}};
  const SurfacePoint p = surface_at(g, ray, {3, {0, 0}, 0.25, 0.5});
  EXPECT_LE(length(p.position - Vec3{1.5, 2, 2}), 1e-15);
  EXPECT_EQ(p.geometric_normal, (Vec3{0, 1, 0}));
  EXPECT_EQ(p.uv, (Vec2{0.625, 0.75}));
  EXPECT_EQ(p.material, MaterialId{7});
}

}  // namespace
}  // namespace bandsaw
