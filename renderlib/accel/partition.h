#pragma once

// One step of the build of a binary BVH (binary_tree.cpp): partitions a range of items (boxes with
// an index, tree_item.h) in two, or decides that it becomes a leaf.

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/accel/best_split.h"
#include "renderlib/accel/tree_item.h"

namespace bandsaw {

/// A range of items that becomes a subtree.
struct Range {
  std::uint32_t first;
  std::uint32_t end;
  std::size_t depth;  ///< 1 for the root
  std::size_t list;   ///< index in TwoLists of the list that holds the items, 0 or 1
  LaneBox box;
  LaneBox centres;  ///< bounding box of lo + hi of all items (twice_centre())

  std::uint32_t count() const { return end - first; }
};

/// Double buffer of items: partitioning a range moves it to the same positions in the other list.
using TwoLists = std::array<absl::Span<TreeItem>, 2>;

inline absl::Span<TreeItem> items_of(const TwoLists& lists, const Range& range) {
  return lists[range.list].subspan(range.first, range.count());
}
/// Returns `range` with `box` and `centres` computed from its items.
Range bounded(const TwoLists& lists, Range range);

/// Partition of a range in steps: bin() for each piece, choose(), move() for each piece, parts().
/// Pieces can be processed in parallel, and the result does not depend on how the range is cut into
/// pieces: minimum, maximum and count are independent of order, and items keep their order.
class Partition {
 public:
  struct Piece {
    absl::Span<const TreeItem> items;
    Bins bins = {};                       ///< set by bin()
    std::array<TreeItem*, 2> to = {};     ///< left and right destination; set by choose()
    std::array<LaneBox, 2> centres = {};  ///< left and right, as Range::centres; set by move()
  };

  /// The items of all pieces, in order, MUST be those of the range.
  Partition(const TwoLists& lists, const Range& range, absl::Span<Piece> pieces);

  /// Computes the bins of the piece.
  void bin(Piece& piece) const;
  /// Selects the split. Returns false if the range becomes a leaf. In that case no other function
  /// is to be called.
  bool choose();
  /// Copies the items of the piece to the other list, if they are split at a plane.
  void move(Piece& piece) const;
  /// Sets the two ranges into which the range was split.
  void parts(Range& left, Range& right) const;

 private:
  /// Returns the cheapest split. The cost is infinite if no plane separates the items, or if the
  /// range must be halved.
  Split find_split() const;
  bool has_plane() const;
  void part_without_plane(Range& left, Range& right) const;

  const TwoLists& lists_;
  const Range& range_;
  absl::Span<Piece> pieces_;
  bool must_;  ///< the range cannot be a leaf
  bool deep_;  ///< the range must be halved because of the maximum depth
  Binning binning_;
  Split split_;
};

/// Partitions a range on this thread and sets `left` and `right`; returns false if it becomes a
/// leaf.
bool partition_range(const TwoLists& lists, const Range& range, Range& left, Range& right);

}  // namespace bandsaw
