// Tests meshes that deform while the shutter is open. The hits on such a mesh at a time equal the
// hits on a static mesh with the interpolated positions, to the bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "renderlib/accel/accel.h"
#include "renderlib/accel/mesh_tree.h"
#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/math/float3.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;

constexpr Interval kShutter = {0.25, 1.5};

/// Returns a closed mesh, a sphere with random radii around `at`. Its vertices move along straight
/// lines, except for some that do not move. At all times it contains the ball around `at` with the
/// radius `size` / 2.
Mesh deforming_sphere(double size, const Vec3& at, int slices = 24, int stacks = 12) {
  const auto placed = [&](double spread, std::uint64_t seed) {
    return test::moved(test::scaled(test::rough_sphere(slices, stacks, spread, seed), size), at);
  };
  Mesh mesh = placed(3, 1);
  mesh.positions_at_close = placed(4, 2).positions;
  for (std::size_t i = 0; i < mesh.positions.size(); i += 5) {
    mesh.positions_at_close[i] = mesh.positions[i];
  }
  return mesh;
}

/// Returns the static mesh with the positions and normals that `mesh` has at `time`.
Mesh mesh_at(const Mesh& mesh, double time) {
  Mesh still = mesh;
  const ShutterTime now(kShutter, time);
  for (std::size_t i = 0; i < still.positions.size(); ++i) {
    still.positions[i] = now.between(mesh.positions[i], mesh.positions_at_close[i]);
  }
  for (std::size_t i = 0; i < still.normals_at_close.size(); ++i) {
    still.normals[i] = now.between(mesh.normals[i], mesh.normals_at_close[i]);
  }
  still.positions_at_close.clear();
  still.normals_at_close.clear();
  return still;
}

/// Returns a scene of the mesh alone, with the shutter interval kShutter.
Geometry of_mesh(Mesh mesh) {
  Geometry g;
  g.shutter = kShutter;
  g.meshes.push_back(std::move(mesh));
  g.instances.push_back({MeshId{0}, {}, {}});
  return g;
}

/// Returns a time in the shutter interval. Depending on `i`, it is an end of the interval, just
/// before the end, the middle, or a random time.
double time_of(int i, Random& random) {
  switch (i % 6) {
    case 0:
      return kShutter.open;
    case 1:
      return kShutter.close;
    case 2:
      return std::nextafter(kShutter.close, 0.0);
    case 3:
      return (kShutter.open + kShutter.close) / 2;
    default:
      return random.uniform(kShutter.open, kShutter.close);
  }
}

TEST(ShutterTime, IsExactAtBothEndsAndStaysBetweenThem) {
  Random random(1);
  const auto number = [&] {
    return static_cast<float>(
        std::ldexp(random.uniform(-1, 1), static_cast<int>(random.below(60)) - 30));
  };
  const ShutterTime open(kShutter, kShutter.open);
  const ShutterTime close(kShutter, kShutter.close);
  for (int i = 0; i < 200'000; ++i) {
    const float a = number();
    const float b = i % 7 == 0 ? a : number();
    ASSERT_EQ(open.between(a, b), a);
    ASSERT_EQ(close.between(a, b), b);
    const ShutterTime now(kShutter, time_of(i, random));
    const float x = now.between(a, b);
    ASSERT_GE(x, std::min(a, b));
    ASSERT_LE(x, std::max(a, b));
    const double exact = a + double{now.share} * (double{b} - a);
    ASSERT_NEAR(x, exact, 0x1p-23 * std::max(std::abs(a), std::abs(b)));
  }
  EXPECT_EQ(ShutterTime(kShutter, -7).share, 0);
  EXPECT_EQ(ShutterTime(kShutter, 7).share, 1);
  EXPECT_EQ(ShutterTime({2, 2}, 2).share, 0);
}

TEST(Deforming, HitsEqualThoseOfTheInterpolatedMesh) {
  Pool pool(2);
  Random random(2);
  for (const double offset : {0.0, 1e4}) {
    for (const double size : {1.0, 1e-3}) {
      const Vec3 at = offset * Vec3{1, -0.5, 0.3};
      const Geometry g = of_mesh(deforming_sphere(size, at));
      const Accel accel = Accel::build(g, pool);
      for (int when = 0; when < 24; ++when) {
        const double time = time_of(when, random);
        const Geometry still = of_mesh(mesh_at(g.meshes[0], time));
        const Accel standing = Accel::build(still, pool);
        int hits = 0;
        for (int i = 0; i < 500; ++i) {
          Ray ray{
              .origin = at + 5 * size * test::random_point(random), .direction = {}, .time = time};
          ray.direction = at + 3 * size * test::random_point(random) - ray.origin;
          const Hit hit = accel.closest(ray);
          ASSERT_TRUE(test::same_hit(standing.closest(ray), hit)) << time << " " << i;
          ASSERT_EQ(accel.occluded(ray), static_cast<bool>(hit));
          if (hit) {
            ++hits;
            ASSERT_TRUE(
                test::same_hit(standing.closest_after(ray, hit), accel.closest_after(ray, hit)));
            ray.t_max = hit.t;
            ASSERT_FALSE(accel.occluded(ray));
            ray = {ray.origin + hit.t * ray.direction, ray.direction, kInfinity, hit.id, time};
            ASSERT_TRUE(test::same_hit(standing.closest(ray), accel.closest(ray)));
          }
        }
        EXPECT_GT(hits, 100);
      }
    }
  }
}

// The scene has many instances of the deforming mesh. Some of them are mirrored, and some are in a
// frame that moves too. A static sphere is among them.
TEST(Deforming, EqualsBruteForceInInstances) {
  Pool pool(1);
  Random random(3);
  Geometry g = of_mesh(deforming_sphere(0.2, {}, 12, 6));
  g.spheres.push_back({{0, 0, 0}, 0.4, {}});
  g.frames.push_back({kNoFrame, {}, {Key(0, {}), Key(2, rotation({1, 2, 0}, 80))}});
  for (int i = 0; i < 24; ++i) {
    Instance instance{.to_world = translation(2 * test::random_point(random)) *
                                  rotation(test::random_direction(random), 40) *
                                  scaling({1, i % 2 == 0 ? 1.5 : -0.5, 1})};
    instance.frame = i % 3 == 0 ? FrameId{0} : kNoFrame;
    g.instances.push_back(instance);
  }
  const Accel accel = Accel::build(g, pool);
  int hits = 0;
  for (int i = 0; i < 2'000; ++i) {
    Ray ray{
        .origin = 5 * test::random_direction(random), .direction = {}, .time = time_of(i, random)};
    ray.direction = 2 * test::random_point(random) - ray.origin;
    const Hit expected = test::closest_by_brute_force(g, ray);
    ASSERT_TRUE(test::same_hit(expected, accel.closest(ray))) << i;
    ASSERT_EQ(accel.occluded(ray), static_cast<bool>(expected));
    hits += expected ? 1 : 0;
  }
  EXPECT_GT(hits, 1'000);
}

// Rays start inside the mesh. They aim at the positions that corners and edges have at the ray's
// time.
TEST(Deforming, DoesNotLeakAtAnyTime) {
  Pool pool(1);
  Random random(4);
  // Returns how many of `count` rays miss the mesh, whose middle is at `at`.
  const auto lost = [&](const Mesh& mesh, const Vec3& at, double size, int count) {
    const Geometry g = of_mesh(mesh);
    const Accel accel = Accel::build(g, pool);
    int escaped = 0;
    for (int i = 0; i < count; ++i) {
      const double time = time_of(i, random);
      const auto triangle = random.below(static_cast<std::uint32_t>(mesh.triangles.size()));
      const auto corners = corners_at(mesh, triangle, kShutter, time);
      const double s = i % 2 == 0 ? 0 : random.uniform();
      Ray ray{
          .origin = at + (0.3 * size) * test::random_point(random), .direction = {}, .time = time};
      ray.direction = lerp(vec3(corners[0]), vec3(corners[1]), s) - ray.origin;
      escaped += accel.closest(ray) && accel.occluded(ray) ? 0 : 1;
    }
    return escaped;
  };
  EXPECT_EQ(lost(deforming_sphere(1, {}), {}, 1, 100'000), 0);
  EXPECT_EQ(lost(deforming_sphere(1, {}, 200, 12), {}, 1, 100'000), 0) << "needles";
  for (const double offset : {1e3, 1e5}) {
    const Vec3 at = {offset, offset / 7, -offset};
    EXPECT_EQ(lost(deforming_sphere(1, at), at, 1, 50'000), 0) << offset;
  }
  for (const double scale : {0x1p-40, 1e-6, 0x1p40}) {
    EXPECT_EQ(lost(deforming_sphere(scale, {}), {}, scale, 20'000), 0) << scale;
  }
  // The vertices cross the whole mesh, because the sphere turns by a right angle.
  Mesh turned = test::icosphere(3);
  for (const std::array<float, 3>& p : turned.positions) {
    turned.positions_at_close.push_back({p[1], -p[0], p[2]});
  }
  EXPECT_EQ(lost(turned, {}, 1, 100'000), 0);
}

// The triangles of one closed mesh belong alternately to two meshes. The two meshes have the same
// positions at their common edges, so no ray gets through between them.
TEST(Deforming, TwoMeshesWithOneBorderDoNotLeak) {
  Pool pool(1);
  Random random(5);
  const Mesh whole = deforming_sphere(1, {});
  Geometry g = of_mesh(whole);
  g.meshes.push_back(whole);
  for (std::size_t part = 0; part < 2; ++part) {
    std::size_t number = 0;
    std::erase_if(g.meshes.change(part).triangles,
                  [&](const auto&) { return number++ % 2 == part; });
  }
  g.instances.push_back({MeshId{1}, {}, {}});
  const Accel accel = Accel::build(g, pool);
  for (int i = 0; i < 50'000; ++i) {
    const double time = time_of(i, random);
    const auto at = corners_at(
        whole, random.below(static_cast<std::uint32_t>(whole.triangles.size())), kShutter, time);
    Ray ray{.origin = 0.3 * test::random_point(random), .direction = {}, .time = time};
    ray.direction = lerp(vec3(at[0]), vec3(at[1]), random.uniform()) - ray.origin;
    ASSERT_TRUE(accel.closest(ray)) << i;
  }
}

/// Checks all leaves at the time `now`. A leaf has a box and a pack of up to eight triangles. The
/// box must contain the triangles. FlatPack::size must be at least the absolute value of each
/// coordinate of the vectors from the first corner of a triangle to its other corners. Returns the
/// number of coordinates that were checked; 0 after a failure.
std::int64_t check_boxes(const MeshTree& tree, const ShutterTime& now) {
  std::int64_t checked = 0;
  for (std::size_t n = 0; n < tree.tree.nodes.size(); ++n) {
    const WideNode& node = tree.tree.nodes[n];
    for (std::size_t child = 0; child < WideNode::kChildren; ++child) {
      if (node.bounds[0][child] == FloatBox::kInf || !node.child[child].is_leaf()) {
        continue;
      }
      const FlatPack pack = pack_at(tree, node.child[child].leaf_index(), now);
      const auto side = [&](std::size_t row) {
        return std::fma(tree.changes[n][row][child], now.share, node.bounds[row][child]);
      };
      for (std::size_t lane = 0; lane < kPackSize && (pack.lanes >> lane & 1u) != 0; ++lane) {
        for (std::size_t which = 0; which < 3; ++which) {
          for (std::size_t k = 0; k < 3; ++k) {
            const float x = pack.vertex(lane, which)[k];
            const bool holds = side(k) <= x && x <= side(k + 3) &&
                               std::abs(double{x} - pack.vertex(lane, 0)[k]) <= pack.size;
            EXPECT_TRUE(holds) << side(k) << " " << x << " " << side(k + 3);
            if (!holds) {
              return 0;
            }
            ++checked;
          }
        }
      }
    }
  }
  return checked;
}

TEST(Deforming, BoxesAndPackSizesAreValidAtEveryTime) {
  Random random(6);
  std::int64_t checked = 0;
  for (int scene = 0; scene < 30; ++scene) {
    const double size = std::pow(10, random.uniform(-3, 3));
    const Vec3 at = std::pow(10, random.uniform(-2, 4)) * test::random_direction(random);
    const MeshTree tree = build_mesh_tree(deforming_sphere(size, at), nullptr);
    ASSERT_TRUE(tree.deforms());
    for (int i = 0; i < 20; ++i) {
      checked += check_boxes(tree, ShutterTime(kShutter, time_of(i, random)));
    }
  }
  EXPECT_GT(checked, 1'000'000);
}

// The vertices move by about the largest float. The change of a box is larger than the movement of
// the vertices by a margin, so the change exceeds the range of floats. The boxes must still contain
// their triangles.
TEST(Deforming, BoxesAreValidIfTheirChangeOverflows) {
  for (const auto& [open, close] :
       {std::pair(-0x1.8459fep127f, 0x1.ee98p125f), std::pair(-0x1.cd5030p126f, 0x1.1957e6p127f)}) {
    Mesh mesh;
    for (std::uint32_t i = 0; i < 60; ++i) {
      const auto y = static_cast<float>(i / 3);
      mesh.positions.push_back({open, y, static_cast<float>(i % 3)});
      mesh.positions_at_close.push_back({close, y, static_cast<float>(i % 3)});
      if (i % 3 == 0) {
        mesh.triangles.push_back({i, i + 1, i + 2});
        mesh.positions.back()[1] += 0.5f;
        mesh.positions_at_close.back()[1] += 0.5f;
      }
    }
    ASSERT_TRUE(std::isfinite(close - open));
    const MeshTree tree = build_mesh_tree(mesh, nullptr);
    for (const double time : {0.25, 0.3, 0.875, 1.5}) {
      // 20 triangles have 3 corners of 3 coordinates.
      EXPECT_EQ(check_boxes(tree, ShutterTime(kShutter, time)), 180);
    }
  }
}

// A bad triangle has two equal corners or a bad vertex. A vertex is bad if it does not exist, if it
// is not finite at an end of the shutter interval, or if it moves farther than the largest float.
// Bad triangles are left out and change no bit of the hits on the others.
TEST(Deforming, BadTrianglesDoNotChangeTheOthers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const float most = std::numeric_limits<float>::max();
  const Mesh good = deforming_sphere(1, {});
  Mesh bad = good;
  const auto first = static_cast<std::uint32_t>(bad.positions.size());
  bad.positions.insert(bad.positions.end(), {{nan, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, -most, 0}});
  bad.positions_at_close.insert(bad.positions_at_close.end(),
                                {{0, 0, 0}, {0, nan, 0}, {0, 0, inf}, {0, most, 0}});
  for (std::uint32_t i = 0; i < 4; ++i) {
    bad.triangles.push_back({0, 1, first + i});
  }
  bad.triangles.push_back({0, 1, 1});
  bad.triangles.push_back({0, 1, 0xffffffffu});
  const Geometry g = of_mesh(good);
  const Geometry with_bad = of_mesh(bad);
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Accel accel_bad = Accel::build(with_bad, pool);
  Random random(7);
  for (int i = 0; i < 5'000; ++i) {
    const Ray ray{.origin = 3 * test::random_point(random),
                  .direction = test::random_direction(random),
                  .time = time_of(i, random)};
    ASSERT_TRUE(test::same_hit(accel.closest(ray), accel_bad.closest(ray)));
  }
}

TEST(Deforming, SurfacePointsEqualThoseOfTheInterpolatedMesh) {
  Random random(8);
  Mesh mesh = deforming_sphere(1, {});
  mesh.normals = mesh.positions;
  mesh.normals_at_close = mesh.positions_at_close;
  for (const auto& p : mesh.positions) {
    mesh.uvs.push_back({p[0], p[1] + p[2]});
  }
  const Geometry g = of_mesh(mesh);
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  for (int i = 0; i < 200; ++i) {
    const double time = time_of(i, random);
    const Geometry still = of_mesh(mesh_at(mesh, time));
    const Ray ray{.origin = {}, .direction = test::random_direction(random), .time = time};
    const Hit hit = accel.closest(ray);
    ASSERT_TRUE(hit);
    SurfacePoint found = surface_at(g, ray, hit);
    SurfacePoint expected = surface_at(still, ray, hit);
    add_uv_directions(g, false, found);
    add_uv_directions(still, false, expected);
    ASSERT_EQ(found.position, expected.position);
    ASSERT_EQ(found.geometric_normal, expected.geometric_normal);
    ASSERT_EQ(found.shading_normal, expected.shading_normal);
    ASSERT_EQ(found.along_u, expected.along_u);
    ASSERT_EQ(found.away, expected.away);
  }
}

}  // namespace
}  // namespace bandsaw
