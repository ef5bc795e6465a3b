#pragma once

// Binned SAH: selects the cheapest plane between bins of the items' centres.

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
  double cost = std::numeric_limits<double>::infinity();  ///< sum of area times number of packs
  std::size_t axis = 0;
  std::uint32_t bin = 0;
};

/// Maps centres of items to bins on each axis.
class Binning {
 public:
  static constexpr std::uint32_t kBins = 16;

  /// `centres` is the bounding box of the items' twice_centre().
  explicit Binning(const LaneBox& centres);

  bool has_extent(std::size_t axis) const { return has_extent_[axis]; }
  /// Returns in lanes 0 to 2 the bin plus a fraction, in [0, kBins - 1] for any centre.
  Float8 place(Float8 centre) const {
    return min((centre - first_) * scale_, Float8(static_cast<float>(kBins - 1)));
  }

 private:
  std::array<bool, 3> has_extent_;
  Float8 first_;
  Float8 scale_;
};

/// Bounding boxes and item counts of a range, by bin.
class Bins {
 public:
  void add(absl::Span<const TreeItem> items, const Binning& binning);
  void add(const Bins& other);
  /// Returns the cheapest split; its cost is infinite if no plane has items on both sides.
  Split best_split(const Binning& binning) const;
  std::uint32_t left_count(const Split& split) const;
  /// Returns the bounding boxes left and right of a plane.
  std::array<LaneBox, 2> boxes(const Split& split) const;

 private:
  template <class T>
  using Rows = std::array<std::array<T, Binning::kBins>, 3>;
  Rows<LaneBox> box_;
  Rows<std::uint32_t> count_ = {};
};

/// Copies `items` to their left or right destination, preserving their order. Returns the bounding
/// boxes of the centres of both sides.
std::array<LaneBox, 2> part(absl::Span<const TreeItem> items, const Binning& binning,
                            const Split& split, std::array<TreeItem*, 2> to);

}  // namespace bandsaw
