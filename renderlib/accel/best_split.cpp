// Sorts a range of items into 16 bins on each axis, by the centres of their boxes. An item is the
// bounding box of a primitive or an instance, with the index of what it bounds. For each bin, the
// items are counted and their common bounding box is computed. Then the bins of each axis are swept
// from both sides to find the plane between two bins with the lowest cost.

#include "renderlib/accel/best_split.h"

#include <cmath>

namespace bandsaw {
namespace {

/// Returns the number of packs (leaves of up to kPackSize primitives) that `count` items need.
double packs_of(std::uint32_t count) {
  return static_cast<double>((count + kPackSize - 1) / kPackSize);
}

}  // namespace

Binning::Binning(const LaneBox& centres) {
  const FloatBox box = centres.box();
  // For the unused lanes, which may hold denormal numbers, `first` is 1 and `scale` is 0. So
  // place() returns 0 in these lanes, and multiplies no denormal number, which would be slow.
  std::array<float, 8> first = {0, 0, 0, 1, 1, 1, 1, 1};
  std::array<float, 8> scale = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const float s = static_cast<float>(kBins) / (box.hi[k] - box.lo[k]);
    has_extent_[k] = std::isfinite(s) && s > 0;
    first[k] = box.lo[k];
    scale[k] = has_extent_[k] ? s : 0;
  }
  first_ = Float8::load(first.data());
  scale_ = Float8::load(scale.data());
}

void Bins::add(absl::Span<const TreeItem> items, const Binning& binning) {
  for (const TreeItem& item : items) {
    const Float8 lanes = Float8::from_bytes(item);
    const LaneBox box = LaneBox::of(lanes);
    std::array<std::int32_t, 8> bin;
    binning.place(twice_centre(lanes)).store_truncated(bin.data());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto b = static_cast<std::size_t>(bin[k]);
      box_[k][b].add(box);
      ++count_[k][b];
    }
  }
}

void Bins::add(const Bins& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t b = 0; b < Binning::kBins; ++b) {
      box_[k][b].add(other.box_[k][b]);
      count_[k][b] += other.count_[k][b];
    }
  }
}

Split Bins::best_split(const Binning& binning) const {
  Split best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!binning.has_extent(axis)) {
      continue;
    }
    // A side without items has cost 0 * infinity = NaN, which is never less than the best cost.
    std::array<double, Binning::kBins> right_cost;
    LaneBox box;
    std::uint32_t count = 0;
    for (std::uint32_t b = Binning::kBins - 1; b > 0; --b) {
      box.add(box_[axis][b]);
      count += count_[axis][b];
      right_cost[b] = packs_of(count) * box.area();
    }
    box = {};
    count = 0;
    for (std::uint32_t b = 1; b < Binning::kBins; ++b) {
      box.add(box_[axis][b - 1]);
      count += count_[axis][b - 1];
      const double cost = packs_of(count) * box.area() + right_cost[b];
      if (cost < best.cost) {
        best = {cost, axis, b};
      }
    }
  }
  return best;
}

std::uint32_t Bins::left_count(const Split& split) const {
  std::uint32_t count = 0;
  for (std::uint32_t b = 0; b < split.bin; ++b) {
    count += count_[split.axis][b];
  }
  return count;
}

std::array<LaneBox, 2> Bins::boxes(const Split& split) const {
  std::array<LaneBox, 2> boxes;
  for (std::uint32_t b = 0; b < Binning::kBins; ++b) {
    boxes[b < split.bin ? 0 : 1].add(box_[split.axis][b]);
  }
  return boxes;
}

std::array<LaneBox, 2> part(absl::Span<const TreeItem> items, const Binning& binning,
                            const Split& split, std::array<TreeItem*, 2> to) {
  // The loop has no branch on the side of an item, because the side is unpredictable.
  std::array<LaneBox, 2> centres;
  const Float8 plane(static_cast<float>(split.bin));
  for (const TreeItem& item : items) {
    const Float8 lanes = Float8::from_bytes(item);
    const Float8 centre = twice_centre(lanes);
    const std::size_t side = (~(binning.place(centre) < plane).bits() >> split.axis) & 1u;
    lanes.to_bytes(*to[side]++);
    centres[side].add(LaneBox::of(centre));
  }
  return centres;
}

}  // namespace bandsaw
