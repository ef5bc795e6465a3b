// Tests instances that move. The hits at the ray's time equal those of brute force, to the bit. An
// id such as S11 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "renderlib/accel/accel.h"
#include "renderlib/accel/moving_tree.h"
#include "renderlib/geometry/placement.h"
#include "tests/support/brute_force.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;

constexpr Interval kInterval = {0.25, 1.5};

/// Adds a frame: a moving space that contains instances and other frames. Each of the `keys` gives
/// the position of the frame at one time. `placement` is applied after the motion, in the frame
/// `parent`.
FrameId add_frame(Geometry& g, std::vector<Key> keys, FrameId parent = kNoFrame,
                  const Transform& placement = {}) {
  g.frames.push_back({parent, placement, std::move(keys)});
  return FrameId{static_cast<std::uint32_t>(g.frames.size() - 1)};
}

/// Returns a random placement that scales by 0.5 to 2, rotates, and moves to a point of the cube
/// [-size, size]^3.
Transform pose(Random& random, double size) {
  const double s = random.uniform(0.5, 2);
  return translation(size * test::random_point(random)) *
         rotation(test::random_direction(random), random.uniform(0, 360)) *
         scaling({s, random.uniform(0.5, 2), s});
}

/// Returns a scene of about the size `size` around `at`. It has spheres, disks, quads, triangles
/// and a mesh that translate, rotate, and move within moving frames.
Geometry moving_scene(double size, const Vec3& at) {
  Random random(31);
  Geometry g;
  g.shutter = kInterval;
  g.spheres.push_back({at, 0.2 * size, {}});
  g.quads.push_back({at - Vec3{size, size, size}, {2 * size, 0, 0}, {0, 0, 2 * size}, {}});
  g.groups.resize(2);
  g.groups[0].spheres.push_back({{0, 0, 0}, 0.1 * size, {}});
  Shapes& mixed = g.groups[1];
  for (int i = 0; i < 5; ++i) {
    const auto point = [&] { return 0.3 * size * test::random_point(random); };
    mixed.spheres.push_back({point(), 0.05 * size, {}});
    mixed.quads.push_back({point(), point(), point(), {}});
    mixed.triangles.push_back({point(), point(), point(), {}});
    mixed.disks.push_back({point(), test::random_direction(random), 0.1 * size, {}});
  }
  g.meshes.push_back(test::scaled(test::rough_sphere(12, 6, 2, 3), 0.2 * size));
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = at + size * test::random_point(random);
    const Vec3 to = at + size * test::random_point(random);
    FrameId frame{};
    if (i % 3 == 0) {
      frame = add_frame(g, {Key(0.25, translation(from)), Key(1.5, translation(to))});
    } else {
      frame = add_frame(g, {Key(0, translation(at) * pose(random, size)),
                            Key(0.5 + 0.01 * i, translation(at) * pose(random, size)),
                            Key(1.25, translation(at) * pose(random, size)),
                            Key(2, translation(at) * pose(random, size))});
    }
    if (i % 5 == 0) {
      frame = add_frame(g, {Key(0.3, {}), Key(1, rotation({1, 1, 0}, 70) * scaling({1, 2, 1}))},
                        frame, translation({0.1 * size, 0, 0}));
    }
    Instance instance;
    instance.group = i % 3 == 2 ? kNoGroup : GroupId{static_cast<std::uint32_t>(i % 3)};
    instance.to_world = i % 2 == 0 ? Transform{} : rotation({0, 1, 2}, 33) * scaling({1, -0.5, 2});
    instance.frame = frame;
    g.instances.push_back(instance);
  }
  g.instances.push_back({MeshId{0}, {}, translation(at)});
  return g;
}

/// Returns a time in kInterval. Depending on `i`, it is an end of the interval, next to an end, or
/// a random time.
double time_of(int i, Random& random) {
  switch (i % 8) {
    case 0:
      return kInterval.open;
    case 1:
      return kInterval.close;
    case 2:
      return std::nextafter(kInterval.close, 0.0);
    case 3:
      return std::nextafter(kInterval.open, 2.0);
    default:
      return random.uniform(kInterval.open, kInterval.close);
  }
}

TEST(Moving, EqualsBruteForceAtTheRaysTime) {
  Pool pool(2);
  for (const double offset : {0.0, 1e4}) {
    for (const double size : {1.0, 1e-3}) {
      SCOPED_TRACE(offset);
      const Vec3 at = offset * Vec3{1, -0.5, 0.3};
      const Geometry g = moving_scene(size, at);
      const Accel accel = Accel::build(g, pool);
      Random random(7);
      int hits = 0;
      constexpr int kRays = 2'000;
      for (int i = 0; i < kRays; ++i) {
        Ray ray;
        ray.origin = at + 3 * size * test::random_point(random);
        ray.direction = at + size * test::random_point(random) - ray.origin;
        ray.time = time_of(i, random);
        const Hit expected = test::closest_by_brute_force(g, ray);
        const Hit found = accel.closest(ray);
        ASSERT_TRUE(test::same_hit(expected, found))
            << "ray " << i << ": expected t " << expected.t << " and instance "
            << expected.id.instance << ", but found t " << found.t << " and instance "
            << found.id.instance;
        ASSERT_EQ(accel.occluded(ray), static_cast<bool>(expected));
        hits += expected ? 1 : 0;
        if (expected) {
          ray.from = expected.id;
          ray.origin = ray.origin + expected.t * ray.direction;
          ASSERT_TRUE(test::same_hit(test::closest_by_brute_force(g, ray), accel.closest(ray)));
        }
      }
      EXPECT_GT(hits, kRays / 2);
    }
  }
}

// 1,050,000 rays aim at the silhouette of a moving ball. A ray must have the same hit through the
// BVH as by brute force. Brute force uses no BVH: it places the ball at the ray's time, and tests
// the ray against the ball.
TEST(Moving, S11_ABallIsHitAtItsPlaceAtTheRaysTime) {
  Pool pool(1);
  Random random(8);
  for (const double speed : {1.0, 1e3, 1e-3}) {
    Geometry g;
    g.shutter = {0, 1};
    const Vec3 center = {3, -2, 1};
    const Vec3 velocity = speed * Vec3{1, 0.3, -0.2};
    g.groups.resize(1);
    g.groups[0].spheres.push_back({center, 0.5, {}});
    // With two balls, the tree has an inner node, whose box moves.
    for (const Vec3& v : {velocity, -velocity}) {
      Instance moving;
      moving.group = GroupId{0};
      moving.frame = add_frame(g, {Key(0, {}), Key(1, translation(v))});
      g.instances.push_back(moving);
    }
    const Accel accel = Accel::build(g, pool);
    int different = 0;
    int hits = 0;
    for (int i = 0; i < 350'000; ++i) {
      const double choice[] = {0, 1, std::nextafter(1.0, 0.0), random.uniform()};
      const double time = choice[random.below(4)];
      const Vec3 now = center + (i % 2 == 0 ? velocity : -velocity) * time;
      const Vec3 from = now + 3 * test::random_direction(random);
      const Vec3 aside = normalize(cross(now - from, test::random_direction(random)));
      // The silhouette is at an angle of asin(1/6).
      const double rim = 0.5 / std::sqrt(1 - 1 / 36.0) * (1 + 1e-9 * random.uniform(-2, 1));
      Ray ray{from, now + rim * aside - from};
      ray.time = time;
      const Hit expected = test::closest_by_brute_force(g, ray);
      const bool same = test::same_hit(expected, accel.closest(ray));
      different += same ? 0 : 1;
      hits += expected ? 1 : 0;
    }
    EXPECT_EQ(different, 0);
    EXPECT_GT(hits, 50'000);
  }
  test::report_hard_case("S11", "1,050,000 rays: hits equal brute force");
}

// The sides of the boxes are computed in float. The boxes still contain their shapes at every time.
TEST(Moving, B10_BoxesContainTheirShapesAtEveryTime) {
  Pool pool(1);
  Random random(9);
  std::int64_t checked = 0;
  std::int64_t outside = 0;
  for (int scene = 0; scene < 100; ++scene) {
    const double size = std::pow(10, random.uniform(-3, 3));
    const Vec3 at = std::pow(10, random.uniform(-2, 4)) * test::random_direction(random);
    const Geometry g = moving_scene(size, at);
    Prototypes prototypes;
    for (const Mesh& mesh : g.meshes) {
      prototypes.meshes.push_back(std::make_shared<const MeshTree>(build_mesh_tree(mesh, nullptr)));
    }
    for (const Shapes& group : g.groups) {
      prototypes.groups.push_back(build_shapes_tree(group, nullptr));
    }
    const MovingTree tree = build_moving_tree(g, prototypes, nullptr);
    ASSERT_EQ(tree.moving.size(), 60u);
    for (int i = 0; i < 80; ++i) {
      const double time = time_of(i, random);
      const float share = ShutterTime(kInterval, time).share;
      for (std::size_t n = 0; n < tree.tree.nodes.size(); ++n) {
        const WideNode& node = tree.tree.nodes[n];
        for (std::size_t child = 0; child < WideNode::kChildren; ++child) {
          if (node.bounds[0][child] == FloatBox::kInf || !node.child[child].is_leaf()) {
            continue;
          }
          const MovingInstance& moving = tree.moving[node.child[child].leaf_index()];
          const Transform to_world = to_world_at(g, g.instances[moving.instance - 1], time);
          const Box& box = moving.prototype.box();
          const auto side = [&](std::size_t row) {
            return std::fma(tree.changes[n][row][child], share, node.bounds[row][child]);
          };
          for (int corner = 0; corner < 8; ++corner) {
            const Vec3 p = to_world.point({(corner & 1) != 0 ? box.hi.x : box.lo.x,
                                           (corner & 2) != 0 ? box.hi.y : box.lo.y,
                                           (corner & 4) != 0 ? box.hi.z : box.lo.z});
            for (int k = 0; k < 3; ++k) {
              ++checked;
              const auto row = static_cast<std::size_t>(k);
              outside += side(row) > p[k] || side(row + 3) < p[k] ? 1 : 0;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(checked, 10'000'000);
  test::at_most("B10", "box sides that cut off a part of the shape, of more than ten million",
                static_cast<double>(outside), 0);
}

// At the time of a key, a moving instance equals a static one with the key's placement, to the bit.
TEST(Moving, X8_AMovingInstanceEqualsAStaticOneAtEachKey) {
  Random random(10);
  Geometry moving;
  moving.shutter = {0, 1};
  moving.meshes.push_back(test::rough_sphere(16, 8, 2, 3));
  const std::vector<Key> keys = {Key(0, pose(random, 1)), Key(0.4, pose(random, 1)),
                                 Key(1, pose(random, 1))};
  const Transform inner = rotation({1, 2, 3}, 50) * scaling({1, -2, 1});
  Instance instance;
  instance.to_world = inner;
  instance.frame = add_frame(moving, keys);
  moving.instances.push_back(instance);
  Pool pool(1);
  const Accel accel = Accel::build(moving, pool);
  for (const Key& key : keys) {
    Geometry still;
    still.meshes = moving.meshes;
    still.instances.push_back({MeshId{0}, {}, key.at * inner});
    EXPECT_EQ(to_world_at(moving, moving.instances[0], key.time), still.instances[0].to_world);
    const Accel standing = Accel::build(still, pool);
    for (int i = 0; i < 2000; ++i) {
      Ray ray{5 * test::random_direction(random), {}};
      ray.direction = test::random_point(random) - ray.origin;
      ray.time = key.time;
      ASSERT_TRUE(test::same_hit(standing.closest(ray), accel.closest(ray)));
    }
  }
  test::report_hard_case("X8", "hits at key times equal the hits of still instances to the bit");
}

TEST(Moving, NothingMovesBeforeTheFirstKeyOrAfterTheLast) {
  Geometry g;
  g.shutter = {0, 1};
  g.meshes.push_back(test::icosphere(1));
  Instance instance;
  instance.frame =
      add_frame(g, {Key(0.5, translation({0, 0, 0})), Key(0.6, translation({10, 0, 0}))});
  g.instances.push_back(instance);
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const auto hit_at = [&](double x, double time) {
    return static_cast<bool>(
        accel.closest({.origin = {x, 0, 5}, .direction = {0, 0, -1}, .time = time}));
  };
  EXPECT_TRUE(hit_at(0, 0) && hit_at(0, 0.5) && hit_at(5, 0.55) && hit_at(10, 0.6));
  EXPECT_TRUE(hit_at(10, 0.7) && hit_at(10, 1));
  EXPECT_FALSE(hit_at(0, 0.55) || hit_at(10, 0.2) || hit_at(0, 1));
}

}  // namespace
}  // namespace bandsaw
