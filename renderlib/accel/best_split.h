#pragma once

// Binned surface area heuristic (SAH): selects the plane at which a range of items is split while a
// BVH is built (partition.h). Items (tree_item.h) are sorted by their centres into bins, and the
// cheapest plane between two bins is selected.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/types/span.h"
#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/tree_item.h"

namespace bandsaw {

/// A split: items whose bin on `axis` is below `bin` go left.
struct Split {
  /// For each side, the area of its box is multiplied by its number of packs; the cost is the sum
  /// of both products. A pack is the content of a leaf: up to eight primitives, tested together.
  double cost = std::numeric_limits<double>::infinity();
  std::size_t axis = 0;
  std::uint32_t bin = 0;
};

/// Maps centres of items to bins on each axis.
class Binning {
 public:
  static constexpr std::uint32_t kBins = 16;

  /// `centres` is the bounding box of the items' twice_centre(), which is lo + hi of an item's box.
  explicit Binning(const LaneBox& centres);

  /// Returns false if all centres have about the same coordinate on this axis, so that no plane
  /// separates them.
  bool has_extent(std::size_t axis) const { return has_extent_[axis]; }
  /// `centre` is the twice_centre() of an item. Returns in lanes 0 to 2 the item's bin on each
  /// axis, plus a fraction. The values are in [0, kBins - 1].
  Float8 place(Float8 centre) const {
    return min((centre - first_) * scale_, Float8(static_cast<float>(kBins - 1)));
  }

 private:
  std::array<bool, 3> has_extent_;
  Float8 first_;
  Float8 scale_;
};

/// Bounding boxes and item counts of a range, for each bin of each axis.
class Bins {
 public:
  /// Adds each item to its bin on each axis.
  void add(absl::Span<const TreeItem> items, const Binning& binning);
  /// Adds the items of other bins, which MUST have the same Binning.
  void add(const Bins& other);
  /// Returns the cheapest split; its cost is infinite if no plane has items on both sides.
  Split best_split(const Binning& binning) const;
  std::uint32_t left_count(const Split& split) const;
  /// Returns the bounding boxes of the items left and right of the plane.
  std::array<LaneBox, 2> boxes(const Split& split) const;

 private:
  template <class T>
  using Rows = std::array<std::array<T, Binning::kBins>, 3>;
  Rows<LaneBox> box_;
  Rows<std::uint32_t> count_ = {};
};

/// Copies the items that go left to consecutive places from to[0] on, and the items that go right
/// to consecutive places from to[1] on. The items of each side keep their order. Returns for each
/// side the bounding box of twice_centre() of its items.
std::array<LaneBox, 2> part(absl::Span<const TreeItem> items, const Binning& binning,
                            const Split& split, std::array<TreeItem*, 2> to);

}  // namespace bandsaw
