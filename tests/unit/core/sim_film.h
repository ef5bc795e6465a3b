#pragma once

// Which samples of which rows are somewhere, by plain bookkeeping: what the core's own is checked
// against.

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator::sim {

class SimFilm {
 public:
  /// False when a part of it is there already; then nothing was changed.
  bool add(const SampleRange& samples, const RowRange& rows) {
    if (any_of(samples, rows)) {
      return false;
    }
    for (std::uint32_t row = rows.first; row < rows.last; ++row) {
      rows_[row].insert(samples);
    }
    return true;
  }

  bool any_of(const SampleRange& samples, const RowRange& rows) const {
    for (auto it = rows_.lower_bound(rows.first); it != rows_.end() && it->first < rows.last;
         ++it) {
      for (const SampleRange& there : it->second) {
        if (there.first < samples.last && samples.first < there.last) {
          return true;
        }
      }
    }
    return false;
  }

  /// Of each row, how many samples are there from the first without a gap; the least and the most
  /// over the rows.
  std::uint64_t least(std::uint32_t height) const {
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t row = 0; row < height; ++row) {
      const auto it = rows_.find(row);
      std::uint64_t end = 0;
      if (it != rows_.end()) {
        for (const SampleRange& there : it->second) {
          end = there.first == end ? there.last : end;
        }
      }
      least = std::min(least, end);
    }
    return least;
  }

  /// The last sample that any row has.
  std::uint64_t last_sample() const {
    std::uint64_t last = 0;
    for (const auto& [row, there] : rows_) {
      last = std::max(last, there.empty() ? 0 : there.rbegin()->last);
    }
    return last;
  }

 private:
  std::map<std::uint32_t, std::set<SampleRange>> rows_;
};

}  // namespace bandsaw::coordinator::sim
