#pragma once

// One step of a build: a range of items that becomes two, or a leaf.

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/accel/best_split.h"
#include "renderlib/accel/tree_item.h"
#include "renderlib/base/pool.h"

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

class Divider {
 public:
  /// `pool` null: all on this thread. The parts are the same.
  Divider(const TwoLists& lists, Pool* pool) : lists_(lists), pool_(pool) {}

  Range range_of(std::uint32_t first, std::uint32_t end, std::size_t depth, std::size_t list) const;
  absl::Span<TreeItem> items(const Range& range) const {
    return lists_[range.list].subspan(range.first, range.count());
  }
  /// The two parts of a range that is no leaf; false: it is one.
  bool divide(const Range& range, Range& left, Range& right) const;

 private:
  struct Piece;
  bool one_kind(const Range& range) const;
  bool must_split(const Range& range) const;
  void for_each(absl::Span<Piece> pieces, absl::FunctionRef<void(Piece&)> body) const;
  Split find_split(const Binning& binning, absl::Span<Piece> pieces) const;
  void part_at(const Split& split, const Binning& binning, absl::Span<Piece> pieces,
               const Range& range, Range& left, Range& right) const;
  void part_without_plane(const Range& range, Range& left, Range& right) const;
  bool divide(const Range& range, const Binning& binning, absl::Span<Piece> pieces, Range& left,
              Range& right) const;

  TwoLists lists_;
  Pool* pool_;
};

}  // namespace bandsaw
