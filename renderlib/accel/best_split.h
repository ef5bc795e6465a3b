#pragma once

// Where to cut a range of items in two: the cheapest plane between bins of their centres.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/types/span.h"
#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/tree_item.h"

namespace bandsaw {

/// Items whose bin on `axis` is below `bin` go left.
struct Split {
  double cost = std::numeric_limits<double>::infinity();  ///< sum of area times packs
  std::size_t axis = 0;
  std::uint32_t bin = 0;
};

/// Which of the bins of each axis a centre falls into.
class Binning {
 public:
  static constexpr std::uint32_t kBins = 16;

  /// `centres`: the box of the items' twice_centre().
  explicit Binning(const LaneBox& centres);

  bool has_extent(std::size_t axis) const { return has_extent_[axis]; }
  /// In lanes 0 to 2 the bin and a fraction, in [0, kBins - 1] whatever the centre is.
  Float8 place(Float8 centre) const {
    return min((centre - first_) * scale_, Float8(static_cast<float>(kBins - 1)));
  }

 private:
  std::array<bool, 3> has_extent_;
  Float8 first_;
  Float8 scale_;
};

/// What a range holds, bin by bin.
class Bins {
 public:
  void add(absl::Span<const TreeItem> items, const Binning& binning);
  void add(const Bins& other);
  /// cost infinity: no plane has items on both sides.
  Split best_split(const Binning& binning) const;
  std::uint32_t left_count(const Split& split) const;
  /// Of what lies left and right of a plane.
  std::array<LaneBox, 2> boxes(const Split& split) const;

 private:
  template <class T>
  using Rows = std::array<std::array<T, Binning::kBins>, 3>;
  Rows<LaneBox> box_;
  Rows<std::uint32_t> count_ = {};
};

/// Copies `items` to the left and to the right place, where their order stays; returns the boxes of
/// the centres of both.
std::array<LaneBox, 2> part(absl::Span<const TreeItem> items, const Binning& binning,
                            const Split& split, std::array<TreeItem*, 2> to);

}  // namespace bandsaw
