#pragma once

// Where to cut a range of items in two: the cheapest plane between bins of their centres.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "absl/types/span.h"
#include "renderlib/accel/binary_tree.h"

namespace bandsaw {

/// Box of the items, and of their centres.
struct RangeBounds {
  FloatBox box;
  FloatBox centres;

  void add(const TreeItem& item);
};

/// Which of the bins of each axis a centre falls into.
struct Binning {
  static constexpr int kBins = 16;
  std::array<float, 3> first;
  std::array<float, 3> scale;  ///< 0: the centres have no extent there

  explicit Binning(const FloatBox& centres);
  int bin(const FloatBox& box, std::size_t axis) const {
    const auto b = static_cast<int>((box.centre(axis) - first[axis]) * scale[axis]);
    return b < kBins ? b : kBins - 1;
  }
};

struct Bins {
  struct Bin {
    FloatBox box;
    std::uint32_t count = 0;
  };
  std::array<std::array<Bin, Binning::kBins>, 3> axis;

  void add(absl::Span<const TreeItem> items, const Binning& binning);
  void add(const Bins& other);
};

/// Items whose bin on `axis` is below `bin` go left.
struct Split {
  double cost = std::numeric_limits<double>::infinity();  ///< sum of area times packs
  std::size_t axis = 0;
  int bin = 0;
};

/// How many packs `count` items take.
inline double packs_of(std::uint32_t count) {
  return static_cast<double>((count + kPackSize - 1) / kPackSize);
}

/// cost infinity: no plane has items on both sides.
Split best_split(const Bins& bins, const Binning& binning);

}  // namespace bandsaw
