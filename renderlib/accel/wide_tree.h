#pragma once

// A BVH with eight children per node, and bounds in float, rounded outwards. All BVHs of this
// folder have this form; traverse.h traverses them.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderlib/base/huge_vector.h"

namespace bandsaw {

/// Kind of a leaf, which contains primitives of one kind or one instance. Flats are triangles and
/// quads.
enum class LeafKind : std::uint32_t { kFlats, kSpheres, kInstance, kDisks };

/// Refers to a node or to a leaf. A leaf is one instance or one pack, i.e. up to eight primitives
/// that a ray tests together.
class ChildRef {
 public:
  static constexpr std::uint32_t kMaxLeaves = 1u << 29;

  static ChildRef node(std::uint32_t index) { return ChildRef(index); }
  static ChildRef leaf(LeafKind kind, std::uint32_t index) {
    return ChildRef(kLeafBit | (static_cast<std::uint32_t>(kind) << 29) | index);
  }
  explicit ChildRef(std::uint32_t bits = 0) : bits_(bits) {}

  std::uint32_t bits() const { return bits_; }
  bool is_leaf() const { return (bits_ & kLeafBit) != 0; }
  std::uint32_t node_index() const { return bits_; }
  std::uint32_t leaf_index() const { return bits_ & (kMaxLeaves - 1); }
  LeafKind kind() const { return static_cast<LeafKind>((bits_ >> 29) & 3u); }

 private:
  static constexpr std::uint32_t kLeafBit = 1u << 31;
  std::uint32_t bits_;
};

/// Four cache lines. An unused child has bounds that no ray enters (lo = infinity, hi = -infinity)
/// and refers to a leaf, so that even a traversal that enters it terminates.
struct alignas(64) WideNode {
  static constexpr std::size_t kChildren = 8;
  /// lo x, y, z, hi x, y, z, each for the eight children
  std::array<std::array<float, kChildren>, 6> bounds;
  std::array<ChildRef, kChildren> child;

  /// Returns a row of `bounds` by its byte offset, which saves a multiplication during traversal.
  const float* plane(std::size_t bytes) const {
    return reinterpret_cast<const float*>(reinterpret_cast<const char*>(this) + bytes);
  }
};

struct WideTree {
  HugeVector<WideNode> nodes;
  ChildRef root;          ///< a node or a leaf; unspecified if `empty`
  bool empty = true;      ///< no primitives
  std::size_t depth = 0;  ///< number of nodes on the longest path from the root
  float reach = 0;        ///< largest absolute coordinate of any bound

  std::size_t bytes() const { return nodes.capacity() * sizeof(WideNode); }
};

/// Maximum depth of any tree, whatever it is built from (accel/binary_tree.h); it determines the
/// size of the traversal stack.
inline constexpr std::size_t kMaxTreeDepth = 64;

}  // namespace bandsaw
