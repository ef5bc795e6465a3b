// A wide node has eight slots, each for a child: another wide node or a leaf. A leaf is a pack,
// i.e. up to eight shapes that are tested together, or an instance. The first step goes from the
// leaves of the binary tree up. It computes for each subtree the least costs if the subtree gets 1,
// 2, …, 8 slots of a wide node. The second step goes from the root down and builds the wide nodes
// of least cost.

#include "renderlib/accel/collapse.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace bandsaw {
namespace {

constexpr std::size_t kSlots = WideNode::kChildren;
/// Relative times to visit a wide node and a pack, measured (NOTES.md).
constexpr float kNodeCost = 1.0f;
constexpr float kPackCost = 1.5f;

/// Minimum costs of a subtree of the binary tree. Element i is the cost if the subtree may fill at
/// most i + 1 slots of the wide node above it, each with a part of the subtree. Element 0: the
/// subtree fills one slot, so it becomes a leaf, or its root becomes a wide node. If the root
/// becomes a wide node, element 7 is the total cost of this node's children.
struct Costs {
  std::array<float, kSlots> slots;
};

class Collapse {
 public:
  Collapse(const BinaryTree& tree, absl::FunctionRef<ChildRef(const BinaryNode&)> make_leaf)
      : tree_(tree), make_leaf_(make_leaf), costs_(tree.nodes.size()) {
    // Children have larger indices than their parents.
    for (std::size_t i = tree.nodes.size(); i-- > 0;) {
      set_costs(i);
    }
  }

  /// Appends the wide nodes of the subtree of binary node `index` to `wide`, and makes its leaves.
  /// Returns the reference to its wide node or leaf. `depth` is 1 for the root.
  ChildRef build(std::uint32_t index, std::size_t depth, WideTree& wide);

 private:
  /// The binary nodes whose subtrees become the children of one wide node.
  struct Members {
    std::array<std::uint32_t, kSlots> index;
    std::size_t count = 0;
  };
  /// Sets the costs of node `index` from those of its children, which MUST be set already.
  void set_costs(std::size_t index);
  /// Returns how many of `slots` (>= 2) the left child gets at minimum cost, and sets `least` to
  /// this minimum.
  std::size_t left_share(const BinaryNode& node, std::size_t slots, float& least) const;
  void choose(std::uint32_t index, std::size_t slots, Members& members) const;
  float cost(std::uint32_t index, std::size_t slots) const {
    return costs_[index].slots[slots - 1];
  }

  const BinaryTree& tree_;
  absl::FunctionRef<ChildRef(const BinaryNode&)> make_leaf_;
  std::vector<Costs> costs_;
  ChildRef any_leaf_;  ///< the first leaf, once it exists; unused slots refer to it
};

std::size_t Collapse::left_share(const BinaryNode& node, std::size_t slots, float& least) const {
  std::size_t share = 1;
  least = cost(node.left, 1) + cost(node.right, slots - 1);
  for (std::size_t left = 2; left < slots; ++left) {
    const float sum = cost(node.left, left) + cost(node.right, slots - left);
    if (sum < least) {
      least = sum;
      share = left;
    }
  }
  return share;
}

void Collapse::set_costs(std::size_t index) {
  const BinaryNode& node = tree_.nodes[index];
  // The area is relative to that of the root, so that it stays within the range of float. The
  // number 1e-300 prevents 0 / 0.
  const auto area =
      static_cast<float>(node.box.area() / std::max(tree_.nodes[0].box.area(), 1e-300));
  Costs& costs = costs_[index];
  if (node.count > 0) {
    costs.slots.fill(area * kPackCost);
    return;
  }
  for (std::size_t slots = 2; slots <= kSlots; ++slots) {
    left_share(node, slots, costs.slots[slots - 1]);
  }
  costs.slots[0] = area * kNodeCost + costs.slots[kSlots - 1];
  for (std::size_t slots = 1; slots + 1 < kSlots; ++slots) {
    costs.slots[slots] = std::min(costs.slots[slots], costs.slots[slots - 1]);
  }
}

/// Adds to `members` the subtrees into which node `index` is divided at minimum cost if it may fill
/// `slots` (>= 1) slots.
void Collapse::choose(std::uint32_t index, std::size_t slots, Members& members) const {
  const BinaryNode& node = tree_.nodes[index];
  // Takes fewer slots if the cost is the same. If `slots` is kSlots, it is not reduced, because
  // build() then divides the subtree into the children of a new wide node.
  while (slots > 1 && slots < kSlots && cost(index, slots) == cost(index, slots - 1)) {
    --slots;
  }
  if (slots == 1 || node.count > 0) {
    members.index[members.count++] = index;
    return;
  }
  float ignored = 0;
  const std::size_t left = left_share(node, slots, ignored);
  choose(node.left, left, members);
  choose(node.right, slots - left, members);
}

ChildRef Collapse::build(std::uint32_t index, std::size_t depth, WideTree& wide) {
  const BinaryNode& binary = tree_.nodes[index];
  if (binary.count > 0) {
    const ChildRef leaf = make_leaf_(binary);
    any_leaf_ = any_leaf_.is_leaf() ? any_leaf_ : leaf;
    return leaf;
  }
  wide.depth = std::max(wide.depth, depth);
  Members members;
  choose(index, kSlots, members);
  const auto place = static_cast<std::uint32_t>(wide.nodes.size());
  wide.nodes.emplace_back();
  std::array<ChildRef, kSlots> child;
  for (std::size_t i = 0; i < members.count; ++i) {
    child[i] = build(members.index[i], depth + 1, wide);
  }
  WideNode& node = wide.nodes[place];
  for (std::size_t i = 0; i < kSlots; ++i) {
    const bool used = i < members.count;
    const FloatBox box = used ? tree_.nodes[members.index[i]].box : FloatBox{};
    for (std::size_t k = 0; k < 3; ++k) {
      node.bounds[k][i] = box.lo[k];
      node.bounds[k + 3][i] = box.hi[k];
    }
    node.child[i] = used ? child[i] : any_leaf_;
  }
  return ChildRef::node(place);
}

}  // namespace

WideTree collapse(const BinaryTree& tree,
                  absl::FunctionRef<ChildRef(const BinaryNode&)> make_leaf) {
  WideTree wide;
  if (tree.nodes.empty()) {
    return wide;
  }
  wide.empty = false;
  wide.reach = tree.nodes[0].box.reach();
  wide.nodes.reserve(tree.nodes.size() / 8);
  wide.root = Collapse(tree, make_leaf).build(0, 1, wide);
  wide.nodes.shrink_to_fit();
  return wide;
}

}  // namespace bandsaw
