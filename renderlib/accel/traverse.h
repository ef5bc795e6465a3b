#pragma once

// Traversal of a wide BVH along a ray. The box test never rejects a box that contains a hit
// (README.md, "Boxes").

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "renderlib/accel/float_ray.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/simd.h"

namespace bandsaw {

/// Returns the mask of the children that the ray enters before `bound` (in the ray's units). Sets
/// `enter` to the distances at which it enters them.
template <class Float = Float8>
inline unsigned enter_children(const WideNode& node, const FloatRay& ray, float bound,
                               Float& enter) {
  Float first(0.0f);
  Float last(bound);
  for (std::size_t k = 0; k < 3; ++k) {
    const Float in = about_fused(Float::load(node.plane(ray.near[k])), Float(ray.near_factor[k]),
                                 Float(ray.near_offset[k]));
    const Float out = about_fused(Float::load(node.plane(ray.far[k])), Float(ray.far_factor[k]),
                                  Float(ray.far_offset[k]));
    // max() and min() return their second operand if the first is NaN, so a NaN bounds nothing.
    first = max(in, first);
    last = min(out, last);
  }
  enter = first;
  return (first <= last).bits();
}

/// A node has eight children: one is visited next, and at most seven are pushed.
inline constexpr std::size_t kStackSize = 7 * kMaxTreeDepth + 1;

/// Traversal stack. The high half of an entry is the distance at which the ray enters the child's
/// box, the low half is the child. The bits of non-negative floats, read as integers, have the same
/// order as the floats, so entries can be compared as integers.
class TraversalStack {
 public:
  void push(std::uint64_t entry) { entries_[size_++] = entry; }
  /// Pops entries until one is entered before `bound`, and sets `next` to its child. Returns false
  /// if there is none.
  bool pop(float bound, ChildRef& next) {
    const auto limit = std::uint64_t{std::bit_cast<std::uint32_t>(bound)} << 32 | 0xffffffffu;
    while (size_ > 0) {
      const std::uint64_t entry = entries_[--size_];
      if (entry <= limit) {
        next = ChildRef(static_cast<std::uint32_t>(entry));
        return true;
      }
    }
    return false;
  }
  /// Sorts the entries from `bottom` up, with the smallest on top.
  void sort_from(std::size_t bottom) {
    for (std::size_t i = bottom + 1; i < size_; ++i) {
      const std::uint64_t entry = entries_[i];
      std::size_t place = i;
      for (; place > bottom && entries_[place - 1] < entry; --place) {
        entries_[place] = entries_[place - 1];
      }
      entries_[place] = entry;
    }
  }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_ = 0;
  std::array<std::uint64_t, kStackSize> entries_;  // uninitialised on purpose: 3.5 KB per ray
};

/// Returns the nearest of the children in the mask `hits` (not 0) and pushes the others, nearest on
/// top. `enter` are the entry distances.
[[gnu::always_inline]] inline ChildRef nearest_child(const WideNode& node, unsigned hits,
                                                     const Float8& enter, TraversalStack& stack) {
  auto i = static_cast<std::size_t>(std::countr_zero(hits));
  hits &= hits - 1;
  if (hits == 0) {
    return node.child[i];
  }
  alignas(32) std::array<float, WideNode::kChildren> at;
  enter.store(at.data());
  const auto entry = [&](std::size_t child) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(at[child])} << 32 | node.child[child].bits();
  };
  const auto next = [&] {
    i = static_cast<std::size_t>(std::countr_zero(hits));
    hits &= hits - 1;
    return entry(i);
  };
  // Exchanges the two entries if they are in the wrong order. The code has no branch, because a
  // branch would be unpredictable.
  const auto order = [](std::uint64_t& low, std::uint64_t& high) {
    const std::uint64_t change = (low ^ high) & (std::uint64_t{0} - std::uint64_t{high < low});
    low ^= change;
    high ^= change;
  };
  std::uint64_t a = entry(i);
  std::uint64_t b = next();
  order(a, b);
  if (hits == 0) {
    stack.push(b);
    return ChildRef(static_cast<std::uint32_t>(a));
  }
  std::uint64_t c = next();
  order(b, c);
  order(a, b);
  if (hits == 0) {
    stack.push(c);
    stack.push(b);
    return ChildRef(static_cast<std::uint32_t>(a));
  }
  std::uint64_t d = next();
  if (hits == 0) {
    order(c, d);
    order(b, c);
    order(a, b);
    stack.push(d);
    stack.push(c);
    stack.push(b);
    return ChildRef(static_cast<std::uint32_t>(a));
  }
  const std::size_t bottom = stack.size();
  stack.push(d);
  stack.push(c);
  stack.push(b);
  stack.push(a);
  do {
    stack.push(next());
  } while (hits != 0);
  stack.sort_from(bottom);
  ChildRef nearest;
  stack.pop(std::numeric_limits<float>::infinity(), nearest);
  return nearest;
}

/// Returns any of the children in the mask `hits` and pushes the others: for any-hit traversal,
/// which needs no order.
inline ChildRef some_child(const WideNode& node, unsigned hits, TraversalStack& stack) {
  auto i = static_cast<std::size_t>(std::countr_zero(hits));
  for (hits &= hits - 1; hits != 0; hits &= hits - 1) {
    stack.push(node.child[i].bits());
    i = static_cast<std::size_t>(std::countr_zero(hits));
  }
  return node.child[i];
}

/// Calls leaf(child) for each leaf that the ray enters before `bound`, a float that leaf() may
/// lower. Stops and returns true as soon as leaf() returns true. If kSorted, nearer boxes are
/// visited first. enter(index, at) does what enter_children() does, for the node with that index.
template <bool kSorted, class Enter, class Leaf>
[[gnu::always_inline]] inline bool traverse(const WideTree& tree, const float& bound,
                                            const Enter& enter, Leaf&& leaf) {
  if (tree.empty) {
    return false;
  }
  TraversalStack stack;
  ChildRef next = tree.root;
  while (true) {
    while (!next.is_leaf()) {
      const WideNode& node = tree.nodes[next.node_index()];
      Float8 at;
      const unsigned hits = enter(next.node_index(), at);
      if (hits != 0) {
        next = kSorted ? nearest_child(node, hits, at, stack) : some_child(node, hits, stack);
      } else if (!stack.pop(bound, next)) {
        return false;
      }
    }
    if (leaf(next)) {
      return true;
    }
    if (!stack.pop(bound, next)) {
      return false;
    }
  }
}

/// This overload is for a tree whose boxes do not move. It passes enter_children() to the overload
/// above.
template <bool kSorted, class Leaf>
[[gnu::always_inline]] inline bool traverse(const WideTree& tree, const FloatRay& ray,
                                            const float& bound, Leaf&& leaf) {
  const auto enter = [&](std::uint32_t node, Float8& at) {
    return enter_children(tree.nodes[node], ray, bound, at);
  };
  return traverse<kSorted>(tree, bound, enter, leaf);
}

}  // namespace bandsaw
