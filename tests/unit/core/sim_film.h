#pragma once

// Which samples of which rows are somewhere, who gave them and what they are, by plain bookkeeping:
// what the core's own is checked against.

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "coordinator/core/messages.h"
#include "coordinator/core/renderer.h"

namespace bandsaw::coordinator::sim {

class SimFilm {
 public:
  /// False when a part of it is there already; then nothing was changed.
  bool add(const input::BandStored& band, const RowRange& rows) {
    if (any_of(band.band.samples, rows)) {
      return false;
    }
    const std::uint64_t renderer =
        band.instance.empty() ? band.renderer : renderer_of(band.instance);
    if (void_.contains(renderer)) {
      return true;
    }
    for (std::uint32_t row = rows.first; row < rows.last; ++row) {
      rows_[row][band.band.samples] = {renderer, band.row_digests[row - band.band.rows.first]};
    }
    return true;
  }

  /// What the renderer gave, and gives from now on.
  void retract(std::uint64_t renderer) {
    void_.insert(renderer);
    for (auto& [row, there] : rows_) {
      std::erase_if(there, [&](const auto& entry) { return entry.second.renderer == renderer; });
    }
  }

  /// Rows that the renderer gave.
  void lose(const Band& band, std::uint64_t renderer) {
    for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
      if (const auto part = rows_[row].find(band.samples);
          part != rows_[row].end() && part->second.renderer == renderer) {
        rows_[row].erase(part);
      }
    }
  }

  bool any_of(const SampleRange& samples, const RowRange& rows) const {
    for (auto it = rows_.lower_bound(rows.first); it != rows_.end() && it->first < rows.last;
         ++it) {
      for (const auto& [there, what] : it->second) {
        if (there.first < samples.last && samples.first < there.last) {
          return true;
        }
      }
    }
    return false;
  }

  /// Of each row, how many samples are there from the first without a gap; the least over the rows.
  std::uint64_t least(std::uint32_t height) const {
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t row = 0; row < height; ++row) {
      const auto it = rows_.find(row);
      std::uint64_t end = 0;
      if (it != rows_.end()) {
        for (const auto& [there, what] : it->second) {
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
      last = std::max(last, there.empty() ? 0 : there.rbegin()->first.last);
    }
    return last;
  }

  /// A row of samples [0, end) whose digest is not the one that `honest` gives for (samples, row).
  template <class Honest>
  std::optional<std::uint32_t> wrong_row(std::uint64_t end, Honest honest) const {
    for (const auto& [row, there] : rows_) {
      for (const auto& [samples, what] : there) {
        if (samples.first < end && what.digest != honest(samples, row)) {
          return row;
        }
      }
    }
    return std::nullopt;
  }

 private:
  struct Part {
    std::uint64_t renderer = 0;
    std::uint64_t digest = 0;
  };
  std::map<std::uint32_t, std::map<SampleRange, Part>> rows_;
  std::set<std::uint64_t> void_;
};

}  // namespace bandsaw::coordinator::sim
