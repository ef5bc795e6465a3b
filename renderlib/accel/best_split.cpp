#include "renderlib/accel/best_split.h"

#include <cmath>

namespace bandsaw {

void RangeBounds::add(const TreeItem& item) {
  box.add(item.box);
  for (std::size_t k = 0; k < 3; ++k) {
    const float c = item.box.centre(k);
    centres.lo[k] = c < centres.lo[k] ? c : centres.lo[k];
    centres.hi[k] = c > centres.hi[k] ? c : centres.hi[k];
  }
}

Binning::Binning(const FloatBox& centres) : first(centres.lo), scale{} {
  for (std::size_t k = 0; k < 3; ++k) {
    const float s = static_cast<float>(kBins) / (centres.hi[k] - centres.lo[k]);
    scale[k] = std::isfinite(s) && s > 0 ? s : 0;
  }
}

void Bins::add(absl::Span<const TreeItem> items, const Binning& binning) {
  for (const TreeItem& item : items) {
    for (std::size_t k = 0; k < 3; ++k) {
      Bin& bin = axis[k][static_cast<std::size_t>(binning.bin(item.box, k))];
      bin.box.add(item.box);
      ++bin.count;
    }
  }
}

void Bins::add(const Bins& other) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t b = 0; b < axis[k].size(); ++b) {
      axis[k][b].box.add(other.axis[k][b].box);
      axis[k][b].count += other.axis[k][b].count;
    }
  }
}

Split best_split(const Bins& bins, const Binning& binning) {
  Split best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (binning.scale[axis] == 0) {
      continue;
    }
    const auto& row = bins.axis[axis];
    std::array<double, Binning::kBins> right_cost{};
    FloatBox box;
    std::uint32_t count = 0;
    for (std::size_t b = Binning::kBins - 1; b > 0; --b) {
      box.add(row[b].box);
      count += row[b].count;
      right_cost[b] = count == 0 ? -1 : packs_of(count) * box.area();
    }
    box = {};
    count = 0;
    for (std::size_t b = 1; b < Binning::kBins; ++b) {
      box.add(row[b - 1].box);
      count += row[b - 1].count;
      const double cost = packs_of(count) * box.area() + right_cost[b];
      if (count > 0 && right_cost[b] >= 0 && cost < best.cost) {
        best.cost = cost;
        best.axis = axis;
        best.bin = static_cast<int>(b);
      }
    }
  }
  return best;
}

}  // namespace bandsaw
