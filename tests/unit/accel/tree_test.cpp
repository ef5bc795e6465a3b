// Tests the structure of a BVH: every item is in one leaf, boxes contain their items, the depth is
// bounded, and the tree does not depend on the number of threads that build it. An id such as B7 in
// a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/accel/wide_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include "absl/types/span.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/accel/mesh_tree.h"
#include "renderlib/accel/traverse.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// A tree with one item in each leaf.
WideTree build_tree(absl::Span<const FloatBox> boxes) {
  TreeItems items;
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

/// Returns the items of all leaves that the ray enters.
std::set<std::uint32_t> visited(const WideTree& tree, const Ray& ray) {
  const FloatRay floats(trace_setup(ray.origin, ray.direction, ray.t_max), tree.reach);
  const float bound = floats.above(ray.t_max);
  std::set<std::uint32_t> items;
  traverse</*kSorted=*/true>(tree, floats, bound, [&](ChildRef leaf) {
    items.insert(leaf.leaf_index());
    return false;
  });
  return items;
}

bool is_used(const WideNode& node, std::size_t child) { return node.bounds[0][child] != kInf; }

TEST(Tree, IsEmptyWithoutItems) {
  const WideTree tree = build_tree({});
  EXPECT_TRUE(tree.empty);
  EXPECT_TRUE(visited(tree, {{0, 0, 0}, {0, 0, 1}}).empty());
}

TEST(Tree, OmitsBoxesThatAreEmptyOrNotFinite) {
  const std::vector<FloatBox> boxes = {{{1, 1, 1}, {0, 0, 0}},
                                       {{0, NAN, 0}, {1, 1, 1}},
                                       {{-kInf, 0, 0}, {1, 1, 1}},
                                       {{0, 0, 0}, {1, 1, 1}}};
  const WideTree tree = build_tree(boxes);
  EXPECT_EQ(visited(tree, {{0.5, 0.5, -1}, {0, 0, 1}}), std::set<std::uint32_t>{3});
}

TEST(Tree, ContainsEveryItemOnceInBoxesThatContainIt) {
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

/// Returns 1,000 boxes with one common corner. The edges of each are half as long as those of the
/// box before, and after 240 boxes the lengths start again.
std::vector<FloatBox> nested_boxes() {
  std::vector<FloatBox> boxes;
  for (int i = 0; i < 1000; ++i) {
    const float size = std::ldexp(1.0f, 100 - i % 240);
    boxes.push_back({{0, 0, 0}, {size, size, size}});
  }
  return boxes;
}

TEST(Tree, B7_IsNeverDeeperThanTheTraversalStack) {
  EXPECT_LE(build_tree(nested_boxes()).depth, kMaxTreeDepth);
  const std::vector<FloatBox> same(100000, FloatBox{{0, 0, 0}, {1, 1, 1}});
  const WideTree tree = build_tree(same);
  // If every node halves its items, the depth is log2 of 100,000, rounded up, and one more.
  EXPECT_LE(tree.depth, 18u);
  EXPECT_EQ(visited(tree, {{0.5, 0.5, -1}, {0, 0, 1}}).size(), same.size());
  const std::vector<FloatBox> huge(100, FloatBox{{-3e38f, 0, 0}, {3e38f, 3e38f, 1}});
  EXPECT_LE(build_tree(huge).depth, 8u);  // log2 of 100, rounded up, and one more
  test::report_hard_case("B7",
                         "the tree of 1,000 nested boxes is no deeper than the traversal stack");
}

/// Returns a mesh with so many triangles that the build cuts them into several pieces and tasks for
/// the threads. Many of the triangles are equal, so that no plane separates their boxes.
Mesh mesh_of_pieces() {
  Mesh mesh = test::triangle_soup(60'000, 0.05, 4);
  mesh.triangles.insert(mesh.triangles.end(), 20'000, mesh.triangles.front());
  return mesh;
}

TEST(Tree, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = mesh_of_pieces();
  const MeshTree alone = build_mesh_tree(mesh, nullptr);
  for (const int threads : {1, 2, 3, 8}) {
    Pool pool(threads);
    const MeshTree tree = build_mesh_tree(mesh, &pool);
    ASSERT_EQ(tree.packs.size(), alone.packs.size());
    EXPECT_EQ(
        std::memcmp(tree.packs.data(), alone.packs.data(), alone.packs.size() * sizeof(FlatPack)),
        0);
    ASSERT_EQ(tree.tree.nodes.size(), alone.tree.nodes.size());
    for (std::size_t i = 0; i < alone.tree.nodes.size(); ++i) {
      ASSERT_EQ(tree.tree.nodes[i].bounds, alone.tree.nodes[i].bounds);
      for (std::size_t c = 0; c < WideNode::kChildren; ++c) {
        ASSERT_EQ(tree.tree.nodes[i].child[c].bits(), alone.tree.nodes[i].child[c].bits());
      }
    }
  }
}

}  // namespace
}  // namespace bandsaw
