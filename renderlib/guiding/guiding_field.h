#pragma once

// The field of path guiding: for places all over the scene's surfaces, the directions from which
// light arrives there. It is built from records (guiding_record.h) and then never changes. Paths
// look it up at each surface (integrate/guided_bsdf.h).

#include <array>
#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/base/pool.h"
#include "renderlib/guiding/guiding_cell.h"
#include "renderlib/guiding/guiding_record.h"

namespace bandsaw {

/// A binary tree over space. Each leaf has up to six cells (guiding_cell.h), one for each main
/// direction of the surface's normal. All cells are fitted to one kind of records: paths or
/// photons.
class GuidingTree {
 public:
  /// A node is divided further while its effective number of records is above this number. The
  /// effective number is the square of the sum of the weights over the sum of the squared weights.
  static constexpr double kRecordsOfLeaf = 48;

  GuidingTree() = default;
  /// Fits the cells to the records on the threads of the pool; the result depends only on the
  /// records and their order.
  GuidingTree(std::vector<GuidingRecord> records, Pool& pool);

  /// Returns the cell of a point with this unit normal; nullptr if there is none.
  const GuidingCell* find(const Vec3& position, const Vec3& normal) const {
    if (nodes_.empty()) {
      return nullptr;
    }
    std::uint32_t at = 0;
    while (nodes_[at].axis < 3) {
      const Node& node = nodes_[at];
      at = position[node.axis] < node.split ? at + 1 : node.next;
    }
    const std::uint32_t cell = leaves_[nodes_[at].next][side_of(normal)];
    return cell == kNoCell ? nullptr : &cells_[cell];
  }

  std::size_t cells() const { return cells_.size(); }
  /// Returns the memory of the tree in bytes.
  std::size_t bytes() const;

 private:
  static constexpr std::uint32_t kNoCell = 0xffffffffu;  ///< a side without records
  using Leaf = std::array<std::uint32_t, 6>;             ///< the cell of each side (side_of())
  /// A node in depth-first order: its first child follows it.
  struct Node {
    float split = 0;
    int axis = 3;            ///< 3: a leaf
    std::uint32_t next = 0;  ///< second child, or number of the leaf
  };
  /// Makes the nodes of records [first, last), which it reorders, and appends to `starts` the first
  /// record of each leaf.
  void split(std::vector<GuidingRecord>& records, std::size_t first, std::size_t last, int depth,
             std::vector<std::size_t>& starts);

  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
  std::vector<GuidingCell> cells_;
};

/// The trees of both kinds of records. Without records the field is empty and guides nothing.
class GuidingField {
 public:
  GuidingField() = default;
  /// Builds both trees on the threads of the pool.
  GuidingField(absl::Span<const GuidingRecord> records, Pool& pool);

  /// Returns the cells of a point with this unit normal, on the side that receives light.
  GuidingCells find(const Vec3& position, const Vec3& normal) const {
    return {paths_.find(position, normal), photons_.find(position, normal)};
  }
  std::size_t cells() const { return paths_.cells() + photons_.cells(); }
  /// Returns the memory of the field in bytes.
  std::size_t bytes() const { return paths_.bytes() + photons_.bytes(); }

 private:
  GuidingTree paths_;
  GuidingTree photons_;
};

}  // namespace bandsaw
