#include "renderlib/accel/wide_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "absl/types/span.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/accel/walk.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Wide;

constexpr float kInf = std::numeric_limits<float>::infinity();

/// A tree with one item a leaf.
WideTree build_tree(absl::Span<const FloatBox> boxes) {
  std::vector<TreeItem> items;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i].can_be_hit()) {
      items.push_back({boxes[i], i, LeafKind::kInstance});
    }
  }
  const BinaryTree binary = build_binary_tree(std::move(items), nullptr);
  return collapse(binary, [&binary](const BinaryNode& leaf) {
    return ChildRef::leaf(LeafKind::kInstance, binary.items[leaf.first].index);
  });
}

std::set<std::uint32_t> visited(const WideTree& tree, const Ray& ray) {
  const FloatRay floats(trace_setup(ray.origin, ray.direction, ray.t_max), tree.reach);
  const float bound = floats.above(ray.t_max);
  std::set<std::uint32_t> items;
  walk<true>(tree, floats, bound, [&](ChildRef leaf) {
    items.insert(leaf.leaf_index());
    return false;
  });
  return items;
}

bool is_used(const WideNode& node, std::size_t child) { return node.bounds[0][child] != kInf; }

bool meets(const FloatBox& box, const Ray& ray) {
  WideNode node;
  for (std::size_t k = 0; k < 3; ++k) {
    node.bounds[k].fill(kInf);
    node.bounds[k + 3].fill(-kInf);
    node.bounds[k][5] = box.lo[k];
    node.bounds[k + 3][5] = box.hi[k];
  }
  const FloatRay floats(trace_setup(ray.origin, ray.direction, ray.t_max), box.reach());
  Float8 enter;
  const unsigned met = enter_children(node, floats, floats.above(ray.t_max), enter);
  EXPECT_EQ(met & ~32u, 0u) << "an unused child is entered";
  return met != 0;
}

TEST(Tree, OfNothingIsEmpty) {
  const WideTree tree = build_tree({});
  EXPECT_TRUE(tree.empty);
  EXPECT_TRUE(visited(tree, {{0, 0, 0}, {0, 0, 1}}).empty());
}

TEST(Tree, LeavesOutBoxesThatAreEmptyOrNotFinite) {
  const std::vector<FloatBox> boxes = {{{1, 1, 1}, {0, 0, 0}},
                                       {{0, NAN, 0}, {1, 1, 1}},
                                       {{-kInf, 0, 0}, {1, 1, 1}},
                                       {{0, 0, 0}, {1, 1, 1}}};
  const WideTree tree = build_tree(boxes);
  EXPECT_EQ(visited(tree, {{0.5, 0.5, -1}, {0, 0, 1}}), std::set<std::uint32_t>{3});
}

// Rays within the faces of a box, where 0 times infinity is NaN.
TEST(Tree, B1B4_RaysWithinAFaceMeetTheBox) {
  const FloatBox box = {{0, 0, 0}, {1, 1, 1}};
  for (const double x : {0.0, 1.0}) {
    for (const double zero : {0.0, -0.0}) {
      EXPECT_TRUE(meets(box, {{x, 0.5, -1}, {zero, 0, 1}}));
      EXPECT_TRUE(meets(box, {{x, x, -1}, {zero, zero, 1}}));
      EXPECT_TRUE(meets(box, {{x, 0.5, 2}, {zero, 0, -1}}));
      EXPECT_TRUE(meets(box, {{x, 0.5, -1}, {zero, 1e-320, 1}}));
    }
  }
  EXPECT_FALSE(meets(box, {{1 + 1e-6, 0.5, -1}, {0, 0, 1}}));
  const FloatBox flat = {{0, 0, 0}, {1, 1, 0}};
  EXPECT_TRUE(meets(flat, {{0.5, 0.5, -1}, {0, 0, 1}}));
  EXPECT_TRUE(meets(flat, {{-1, 0.5, 0}, {1, 0, 0}}));
  test::holds("B1", "hit in 4 of 4, and with denormals");
}

/// Whether a ray meets a box, without rounding.
bool truly_meets(const FloatBox& box, const Ray& ray) {
  Wide enter = 0;
  Wide leave = Wide{1e30};
  for (int k = 0; k < 3; ++k) {
    const Wide o = ray.origin[k];
    const Wide d = ray.direction[k];
    const Wide lo = box.lo[static_cast<std::size_t>(k)];
    const Wide hi = box.hi[static_cast<std::size_t>(k)];
    if (d == 0) {
      if (o < lo || o > hi) {
        return false;
      }
      continue;
    }
    const Wide first = (d > 0 ? lo : hi) - o;
    const Wide last = (d > 0 ? hi : lo) - o;
    enter = std::max(enter, first / d);
    leave = std::min(leave, last / d);
  }
  return enter <= leave;
}

TEST(Tree, NeverMissesABoxThatIsMet) {
  test::Random random(1);
  int met = 0;
  for (int i = 0; i < 300000; ++i) {
    const double offset = std::pow(10, random.uniform(-6, 6));
    const Vec3 center = offset * test::random_direction(random);
    const Vec3 size = {std::pow(10, random.uniform(-6, 1)), std::pow(10, random.uniform(-6, 1)),
                       random.below(4) == 0 ? 0 : std::pow(10, random.uniform(-6, 1))};
    const FloatBox box = round_outwards({center - size, center + size});
    // Through a point of an edge, from anywhere.
    Vec3 target;
    double* target_axes[3] = {&target.x, &target.y, &target.z};
    for (std::size_t k = 0; k < 3; ++k) {
      const double u = random.uniform();
      *target_axes[k] = random.below(3) == 0   ? box.lo[k] + u * (double{box.hi[k]} - box.lo[k])
                        : random.below(2) == 0 ? box.lo[k]
                                               : box.hi[k];
    }
    Vec3 d = test::random_direction(random);
    if (random.below(8) == 0) {
      d.x = random.below(2) == 0 ? 0 : 1e-30;
    }
    const Vec3 origin = target - std::pow(10, random.uniform(-3, 3)) * d;
    const Ray ray = {origin, d * std::ldexp(1, static_cast<int>(random.below(80)) - 40)};
    if (truly_meets(box, ray)) {
      ++met;
      ASSERT_TRUE(meets(box, ray)) << i;
    }
  }
  EXPECT_GT(met, 20000);
}

TEST(Tree, HoldsEveryItemOnceInBoxesThatHoldIt) {
  const Mesh soup = test::triangle_soup(5000, 0.1, 2);
  std::vector<FloatBox> boxes;
  for (const auto& t : soup.triangles) {
    Box box;
    for (const std::uint32_t i : t) {
      const auto& p = soup.positions[i];
      box.add({p[0], p[1], p[2]});
    }
    boxes.push_back(round_outwards(box));
  }
  const WideTree tree = build_tree(boxes);
  std::vector<std::uint32_t> order;
  for (const WideNode& node : tree.nodes) {
    for (std::size_t c = 0; c < WideNode::kChildren; ++c) {
      if (!is_used(node, c) || !node.child[c].is_leaf()) {
        continue;
      }
      const std::uint32_t item = node.child[c].leaf_index();
      order.push_back(item);
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LE(node.bounds[k][c], boxes[item].lo[k]);
        ASSERT_GE(node.bounds[k + 3][c], boxes[item].hi[k]);
      }
    }
  }
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), boxes.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    ASSERT_EQ(order[i], i);
  }
}

std::vector<FloatBox> nested_boxes() {
  std::vector<FloatBox> boxes;
  for (int i = 0; i < 1000; ++i) {
    const float size = std::ldexp(1.0f, 100 - i % 240);
    boxes.push_back({{0, 0, 0}, {size, size, size}});
  }
  return boxes;
}

TEST(Tree, B7_IsNeverDeeperThanItsStack) {
  EXPECT_LE(build_tree(nested_boxes()).depth, kMaxDepth);
  const std::vector<FloatBox> same(100000, FloatBox{{0, 0, 0}, {1, 1, 1}});
  const WideTree tree = build_tree(same);
  EXPECT_LE(tree.depth, 18u);
  EXPECT_EQ(visited(tree, {{0.5, 0.5, -1}, {0, 0, 1}}).size(), same.size());
  const std::vector<FloatBox> huge(100, FloatBox{{-3e38f, 0, 0}, {3e38f, 3e38f, 1}});
  EXPECT_LE(build_tree(huge).depth, 8u);
  test::holds("B7", "1,000 nested boxes no deeper than the stack");
}

}  // namespace
}  // namespace bandsaw
