#pragma once

// One step of a build: a range of items that becomes two, or a leaf.

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/accel/best_split.h"
#include "renderlib/accel/tree_item.h"

namespace bandsaw {

/// A range of items that is to become a subtree.
struct Range {
  std::uint32_t first;
  std::uint32_t end;
  std::size_t depth;
  std::size_t list;  ///< which of the two holds it
  LaneBox box;
  LaneBox centres;  ///< of twice_centre()

  std::uint32_t count() const { return end - first; }
};

/// Items lie in one of two lists: parting a range moves it to the other, in its place.
using TwoLists = std::array<absl::Span<TreeItem>, 2>;

inline absl::Span<TreeItem> items_of(const TwoLists& lists, const Range& range) {
  return lists[range.list].subspan(range.first, range.count());
}
/// Sets both boxes.
Range bounded(const TwoLists& lists, Range range);

/// A range on its way to become two, in steps: bin() for each piece, choose(), move() for each
/// piece, parts(). Pieces may be taken side by side, and what they are does not matter: least, most
/// and count are the same in any order, and items stay in theirs.
class Division {
 public:
  struct Piece {
    absl::Span<const TreeItem> items;
    Bins bins = {};
    std::array<TreeItem*, 2> to = {};     ///< left and right
    std::array<LaneBox, 2> centres = {};  ///< left and right
  };

  /// The pieces' items, together and in order, are those of the range.
  Division(const TwoLists& lists, const Range& range, absl::Span<Piece> pieces);

  void bin(Piece& piece) const;
  /// False: the range is a leaf, and nothing more is to be done.
  bool choose();
  void move(Piece& piece) const;
  void parts(Range& left, Range& right) const;

 private:
  Split find_split() const;
  bool has_plane() const;
  void part_without_plane(Range& left, Range& right) const;

  const TwoLists& lists_;
  const Range& range_;
  absl::Span<Piece> pieces_;
  bool must_;
  bool deep_;
  Binning binning_;
  Split split_;
};

/// All on this thread; false: a leaf.
bool divide(const TwoLists& lists, const Range& range, Range& left, Range& right);

}  // namespace bandsaw
