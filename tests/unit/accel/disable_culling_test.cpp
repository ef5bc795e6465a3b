// With Traversal::kBruteForce, every ray enters all boxes of the BVH. The hits are the same as
// those of the usual traversal.

#include "renderlib/accel/disable_culling.h"

#include <gtest/gtest.h>

#include "renderlib/accel/accel.h"
#include "renderlib/accel/traverse.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using test::Random;

/// Static and moving shapes, groups and meshes.
Geometry scene() {
  Random random(5);
  Geometry g;
  const auto point = [&] { return 3 * test::random_point(random); };
  const auto add_some = [&](Shapes& shapes) {
    for (int i = 0; i < 12; ++i) {
      shapes.spheres.push_back({point(), 0.2, {}});
      shapes.quads.push_back({point(), point(), point(), {}});
      shapes.triangles.push_back({point(), point(), point(), {}});
      shapes.disks.push_back({point(), test::random_direction(random), 0.3, {}});
    }
  };
  add_some(g);
  g.groups.resize(1);
  add_some(g.groups[0]);
  g.shutter = {0, 1};
  g.meshes.push_back(test::rough_sphere(12, 6, 2, 3));
  g.meshes.push_back(test::rough_sphere(12, 6, 2, 4));
  g.meshes.change(1).positions_at_close = test::rough_sphere(12, 6, 3, 5).positions;
  const Key at_open{0, {}};
  const Key at_close{1, translation({2, 1, 0})};
  g.frames.push_back({kNoFrame, {}, {at_open, at_close}});
  for (int i = 0; i < 9; ++i) {
    Instance instance{.mesh = MeshId{i % 4 == 1 ? 1u : 0u}, .to_world = translation(point())};
    instance.group = i % 2 == 0 ? GroupId{0} : kNoGroup;
    instance.frame = i % 3 == 0 ? FrameId{0} : kNoFrame;
    g.instances.push_back(instance);
  }
  return g;
}

TEST(DisableCulling, HitsAreTheSameToTheBit) {
  const Geometry geometry = scene();
  Pool pool(1);
  const Accel tree = Accel::build(geometry, pool);
  const Accel everything = Accel::build(geometry, pool, Traversal::kBruteForce);
  Random random(6);
  int hits = 0;
  for (int i = 0; i < 3'000; ++i) {
    Ray ray{.origin = 6 * test::random_point(random),
            .direction = test::random_direction(random),
            .time = random.uniform()};
    const Hit hit = tree.closest(ray);
    ASSERT_TRUE(test::same_hit(everything.closest(ray), hit)) << i;
    ASSERT_EQ(everything.occluded(ray), tree.occluded(ray)) << i;
    if (hit) {
      ++hits;
      ASSERT_TRUE(test::same_hit(everything.closest_after(ray, hit), tree.closest_after(ray, hit)));
    }
  }
  EXPECT_GT(hits, 1'000);
}

// A ray misses two boxes. The traversal enters neither of them with culling, and both without
// culling.
TEST(DisableCulling, EveryBoxIsEntered) {
  WideTree tree;
  WideNode node;
  for (auto& row : node.bounds) {
    row.fill(std::numeric_limits<float>::infinity());
  }
  for (std::size_t axis = 3; axis < 6; ++axis) {
    node.bounds[axis].fill(-std::numeric_limits<float>::infinity());
  }
  for (std::size_t child = 0; child < 2; ++child) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      node.bounds[axis][child] = 10.0f * static_cast<float>(child);
      node.bounds[axis + 3][child] = node.bounds[axis][child] + 1;
    }
  }
  tree.nodes.push_back(node);
  const FloatRay past(trace_setup({0, 50, 0}, {0, 1e-30, 1}, 100), /*reach=*/11);
  Float8 enter;
  EXPECT_EQ(enter_children(tree.nodes[0], past, 100, enter), 0u);
  disable_culling(tree);
  EXPECT_EQ(enter_children(tree.nodes[0], past, 100, enter), 3u);
}

}  // namespace
}  // namespace bandsaw
