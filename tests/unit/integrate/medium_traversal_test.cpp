// Tests the segments of a ray that are inside media. The medium of a segment is compared with the
// shapes that contain the points of the segment. An id such as V6 in a test's name is that of a
// case in tests/hard_cases/cases.txt.

#include "renderlib/integrate/medium_traversal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderlib/sampling/warp.h"
#include "tests/support/hard_case.h"
#include "tests/support/media.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

/// Returns the medium at a point; -1 for none.
using Inside = std::function<int(const Vec3&)>;

/// Checks that segments are in order, not empty, and have the right medium at every point of the
/// ray. Points that are closer to a boundary than the rounding error may belong to either side.
void expect_walk(const Scene& scene, const Ray& ray, double length, const Inside& inside) {
  std::uint64_t rays = 0;
  MediumTraversal walk(scene, ray, length, rays);
  std::vector<MediumSegment> segments;
  while (const auto segment = walk.next()) {
    ASSERT_LT(segment->begin, segment->end);
    ASSERT_GE(segment->begin, segments.empty() ? 0 : segments.back().end);
    ASSERT_LE(segment->end, length);
    segments.push_back(*segment);
  }
  constexpr int kPoints = 400;
  const double far = std::min(length, 30.0);
  for (int i = 0; i < kPoints; ++i) {
    const double t = far * (i + 0.5) / kPoints;
    const Vec3 at = ray.origin + ray.direction * t;
    const int expected = inside(at);
    if (inside(at + ray.direction * 1e-9) != expected ||
        inside(at - ray.direction * 1e-9) != expected) {
      continue;
    }
    int found = -1;
    for (const MediumSegment& segment : segments) {
      if (t >= segment.begin && t < segment.end) {
        found = static_cast<int>(segment.medium - scene.media().media.data());
      }
    }
    ASSERT_EQ(found, expected) << t;
  }
}

/// Returns a ray with a random direction and an origin in the cube from -spread to spread.
Ray random_ray(test::Random& random, double spread) {
  const auto number = [&] { return random.uniform(-spread, spread); };
  const double x = number();
  const double y = number();
  const double z = number();
  const double u = random.uniform();
  return {.origin = {x, y, z}, .direction = sample_sphere(u, random.uniform())};
}

/// The balls of five media overlap, are nested or are disjoint. Where they overlap, the medium with
/// the largest number counts, which is the one that the scene names last. Rays begin anywhere.
TEST(MediumTraversal, V6V7_InOverlapsTheMediumNamedLastCounts) {
  test::Random random(1);
  for (int round = 0; round < 40; ++round) {
    SceneMaker maker;
    for (int i = 0; i < 5; ++i) {
      test::add(maker, test::medium(1, 1));
    }
    const bool with_fog = round % 2 == 1;
    if (with_fog) {
      maker.scene.media.fog = MediumId{2};
    }
    std::vector<Sphere>& balls = maker.scene.media.boundaries.spheres;
    for (int i = 0; i < 12; ++i) {
      const Ray place = random_ray(random, 3);
      balls.push_back({place.origin, random.uniform(0.2, 2.5), MaterialId{random.below(5)}});
    }
    const auto scene = maker.build();
    const Inside inside = [&](const Vec3& p) {
      int top = -1;
      for (const Sphere& ball : balls) {
        if (length(p - ball.center) < ball.radius) {
          top = std::max(top, static_cast<int>(ball.material));
        }
      }
      return top < 0 && with_fog ? 2 : top;
    };
    for (int i = 0; i < 50; ++i) {
      expect_walk(*scene, random_ray(random, 4), i % 2 == 0 ? kInfinity : 3, inside);
    }
  }
}

/// A prism whose base is the letter L: the unit square without its quarter x > 0.5, y > 0.5.
Mesh corner_prism() {
  Mesh mesh;
  const std::array<std::array<float, 2>, 6> base = {
      {{0, 0}, {1, 0}, {1, 0.5f}, {0.5f, 0.5f}, {0.5f, 1}, {0, 1}}};
  for (const float z : {0.0f, 1.0f}) {
    for (const auto& [x, y] : base) {
      mesh.positions.push_back({x, y, z});
    }
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  for (const auto& [a, b, c] :
       {std::array<std::uint32_t, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({a + 6, b + 6, c + 6});
  }
  return mesh;
}

/// A ray may enter and leave a non-convex mesh several times. Boxes count as closed shapes too, and
/// so do shapes with mirrored placements.
TEST(MediumTraversal, V6_SegmentsAreInsideMeshes) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(1, 1));
  const MediumId dust = test::add(maker, test::medium(1, 1));
  const Transform placed =
      translation({-1, 0.5, -1}) * rotation({1, 2, 3}, 50) * scaling({-2, 3, 2});
  test::fill_mesh(maker, corner_prism(), placed, smoke);
  test::fill_box(maker, {-0.5, -0.5, -0.5}, {2, 0.7, 0.9}, dust);
  const auto scene = maker.build();
  const Transform back = *inverse(placed);
  const Inside inside = [&](const Vec3& p) {
    const bool in_box = p.x > -0.5 && p.x < 2 && p.y > -0.5 && p.y < 0.7 && p.z > -0.5 && p.z < 0.9;
    const Vec3 q = back.point(p);
    const bool in_square = q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1 && q.z > 0 && q.z < 1;
    return in_box ? 1 : in_square && !(q.x > 0.5 && q.y > 0.5) ? 0 : -1;
  };
  test::Random random(2);
  for (int i = 0; i < 3000; ++i) {
    expect_walk(*scene, random_ray(random, 3), kInfinity, inside);
  }
  test::report_hard_case("V6", "the medium segments of a ray are the parts inside the mesh");
}

TEST(MediumTraversal, AClearMediumDisplacesOthers) {
  SceneMaker maker;
  test::fog(maker, test::medium(1, 0));
  const MediumId air = test::add(maker, {});
  test::fill_sphere(maker, {0, 0, 0}, 1, air);
  const auto scene = maker.build();
  std::uint64_t rays = 0;
  // The direction has the length 2, so the ray is 6 units long. It is inside the clear
  // ball for 2 units.
  const Ray ray{.origin = {-3, 0, 0}, .direction = {2, 0, 0}, .t_max = 3};
  EXPECT_FLOAT_EQ(media_transmittance(*scene, ray, NumberStream(0), rays).g, std::exp(-4.0f));
}

/// MediumTraversal stores a limited number of crossings in its first pass along a ray. The first
/// ray of this test has more crossings.
TEST(MediumTraversal, FindsEachOfManyBallsInARow) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(0.125f, 0));
  for (int i = 0; i < 100; ++i) {
    test::fill_sphere(maker, {3.0 * i, 0, 0}, 1, smoke);
  }
  const auto scene = maker.build();
  std::uint64_t rays = 0;
  const Ray ray{.origin = {-3, 0, 0}, .direction = {1, 0, 0}};
  EXPECT_NEAR(std::log(media_transmittance(*scene, ray, NumberStream(0), rays).g), -100 * 2 * 0.125,
              1e-4);
  // This ray passes 1 unit of the ball in which it begins, and 2 units of each of the next three
  // balls.
  const Ray inside{.origin = {150, 0, 0}, .direction = {-1, 0, 0}, .t_max = 10};
  EXPECT_FLOAT_EQ(media_transmittance(*scene, inside, NumberStream(0), rays).g,
                  std::exp(-7 * 0.125f));
}

/// Many shapes of one medium contain the same points.
TEST(MediumTraversal, ACloudOfBallsIsTheirUnion) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(1, 0));
  for (int i = 0; i < 40; ++i) {
    test::fill_sphere(maker, {0.05 * i, 0, 0}, 1, smoke);
  }
  const auto scene = maker.build();
  test::Random random(4);
  const Inside inside = [](const Vec3& p) {
    const double x = p.x - 0.05 * std::clamp(std::round(p.x / 0.05), 0.0, 39.0);
    return x * x + p.y * p.y + p.z * p.z < 1 ? 0 : -1;
  };
  expect_walk(*scene, {.origin = {-5, 0.01, 0}, .direction = {1, 0, 0}}, kInfinity, inside);
  expect_walk(*scene, {.origin = {8, 0.01, 0}, .direction = {-1, 0, 0}}, kInfinity, inside);
  expect_walk(*scene, {.origin = {1, 0.01, 0}, .direction = {-1, 0, 0}}, kInfinity, inside);
  for (int i = 0; i < 500; ++i) {
    expect_walk(*scene, random_ray(random, 3), kInfinity, inside);
  }
}

/// A mesh of two overlapping cubes is the union of the cubes, from every direction. The same holds
/// if faces of both cubes are coplanar.
TEST(MediumTraversal, OverlappingPartsOfOneMeshAreOne) {
  for (const Vec3& by : {Vec3{0.5, 0.5, 0.5}, Vec3{0.5, 0, 0}, Vec3{0, 0.5, 0.5}}) {
    SceneMaker maker;
    const MediumId smoke = test::add(maker, test::medium(1, 0));
    Mesh both = unit_cube();
    const Mesh other = test::moved(unit_cube(), by);
    const auto first = static_cast<std::uint32_t>(both.positions.size());
    both.positions.insert(both.positions.end(), other.positions.begin(), other.positions.end());
    both.normals.clear();
    both.uvs.clear();
    for (const auto& corner : other.triangles) {
      both.triangles.push_back({corner[0] + first, corner[1] + first, corner[2] + first});
    }
    test::fill_mesh(maker, both, {}, smoke);
    const auto scene = maker.build();
    const Inside inside = [&](const Vec3& p) {
      const auto in_cube = [&](const Vec3& q) {
        return q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1 && q.z > 0 && q.z < 1;
      };
      return in_cube(p) || in_cube(p - by) ? 0 : -1;
    };
    test::Random random(5);
    for (int i = 0; i < 2000; ++i) {
      expect_walk(*scene, random_ray(random, 1.5), kInfinity, inside);
    }
  }
}

/// The rays pass through the edges and corners that the triangles of a face share.
TEST(MediumTraversal, SharedEdgesAreCrossedOnce) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(1, 0));
  test::fill_box(maker, {0, 0, 0}, {1, 1, 1}, smoke);
  const auto scene = maker.build();
  for (int i = 1; i < 64; ++i) {
    for (const Vec2& at : {Vec2{i / 64.0, i / 64.0}, Vec2{i / 64.0, 1 - i / 64.0}}) {
      std::uint64_t rays = 0;
      const Ray down{.origin = {at.x, at.y, 3}, .direction = {0, 0, -1}};
      EXPECT_FLOAT_EQ(media_transmittance(*scene, down, NumberStream(0), rays).g, std::exp(-1.0f))
          << i;
    }
  }
}

/// The ray passes many balls one after the other. Each has a medium of its own, and a large ball of
/// mist is around all of them.
TEST(MediumTraversal, FindsEachOfManyMediaInARow) {
  SceneMaker maker;
  const MediumId mist = test::add(maker, test::medium(0.125f, 0));
  test::fill_sphere(maker, {0, 0, 0}, 500, mist);
  for (int i = 0; i < 40; ++i) {
    test::fill_sphere(maker, {3.0 * i, 0, 0}, 1, test::add(maker, test::medium(0.25f, 0)));
  }
  const auto scene = maker.build();
  std::uint64_t rays = 0;
  // For each of the 40 balls, the ray passes 2 units of the ball and 1 unit of the mist.
  const Ray ray{.origin = {-2, 0, 0}, .direction = {1, 0, 0}, .t_max = 3.0 * 40};
  EXPECT_NEAR(std::log(media_transmittance(*scene, ray, NumberStream(0), rays).g),
              -40 * (2 * 0.25 + 0.125), 1e-4);
}

/// A ray touches an edge of the box without entering the box, so it crosses nothing.
TEST(MediumTraversal, ATouchedEdgeIsNotCrossed) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(1, 0));
  test::fill_box(maker, {0, 0, 0}, {1, 1, 1}, smoke);
  const auto scene = maker.build();
  const double s = std::sqrt(0.5);
  for (const Vec3& origin : {Vec3{0, -1, 0.53}, Vec3{-1, 0, 0.53}}) {
    std::uint64_t rays = 0;
    const Ray ray{.origin = origin, .direction = {s, s, 0}};
    EXPECT_FLOAT_EQ(media_transmittance(*scene, ray, NumberStream(0), rays).g, 1) << origin.x;
  }
}

/// Overlapping shapes of one medium are one shape. The medium is not denser where they overlap.
TEST(MediumTraversal, OverlapsOfOneMediumAreNotDenser) {
  SceneMaker maker;
  const MediumId smoke = test::add(maker, test::medium(1, 0));
  test::fill_sphere(maker, {0, 0, 0}, 1, smoke);
  test::fill_sphere(maker, {1, 0, 0}, 1, smoke);
  test::fill_sphere(maker, {1, 0, 0}, 1, smoke);
  const auto scene = maker.build();
  std::uint64_t rays = 0;
  const Ray ray{.origin = {-9, 0, 0}, .direction = {1, 0, 0}};
  EXPECT_FLOAT_EQ(media_transmittance(*scene, ray, NumberStream(0), rays).g, std::exp(-3.0f));
}

}  // namespace
}  // namespace bandsaw
