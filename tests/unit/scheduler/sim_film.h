#pragma once

// SimFilm records which samples of each row of an image are stored, with their digests and the
// worker process that rendered them. It is as simple as possible, because the simulated farm checks
// the scheduler's own bookkeeping against it.

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "coordinator/scheduler/api/messages.h"
#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator::sim {

class SimFilm {
 public:
  /// Stores these rows of the band and returns true. If some of their samples are stored already,
  /// changes nothing and returns false. If the process that rendered the band was retracted, stores
  /// nothing and returns true.
  bool add(const input::BandStored& band, const RowRange& rows) {
    if (any_of(band.band.samples, rows)) {
      return false;
    }
    const std::uint64_t process =
        band.instance.empty() ? band.process : worker_process_id(band.instance);
    if (retracted_.contains(process)) {
      return true;
    }
    for (std::uint32_t row = rows.first; row < rows.last; ++row) {
      rows_[row][band.band.samples] = {process, band.row_digests[row - band.band.rows.first]};
    }
    return true;
  }

  /// Removes all rows that the process rendered. Rows of the process that are added later are
  /// ignored.
  void retract(std::uint64_t process) {
    retracted_.insert(process);
    for (auto& [row, parts] : rows_) {
      std::erase_if(parts, [&](const auto& entry) { return entry.second.process == process; });
    }
  }

  /// Removes those rows of this band that the process rendered.
  void lose(const Band& band, std::uint64_t process) {
    for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
      if (const auto part = rows_[row].find(band.samples);
          part != rows_[row].end() && part->second.process == process) {
        rows_[row].erase(part);
      }
    }
  }

  /// Returns true if any of these samples of these rows is stored.
  bool any_of(const SampleRange& samples, const RowRange& rows) const {
    for (auto it = rows_.lower_bound(rows.first); it != rows_.end() && it->first < rows.last;
         ++it) {
      for (const auto& [stored, part] : it->second) {
        if (stored.first < samples.last && samples.first < stored.last) {
          return true;
        }
      }
    }
    return false;
  }

  /// Returns the largest n such that every row of the image has all samples [0, n).
  std::uint64_t least(std::uint32_t height) const {
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t row = 0; row < height; ++row) {
      const auto it = rows_.find(row);
      std::uint64_t end = 0;
      if (it != rows_.end()) {
        for (const auto& [stored, part] : it->second) {
          end = stored.first == end ? stored.last : end;
        }
      }
      least = std::min(least, end);
    }
    return least;
  }

  /// Returns the end of the last sample range that is stored in any row; 0 if there is none.
  std::uint64_t last_sample() const {
    std::uint64_t last = 0;
    for (const auto& [row, parts] : rows_) {
      last = std::max(last, parts.empty() ? 0 : parts.rbegin()->first.last);
    }
    return last;
  }

  /// Checks all sample ranges that begin before `end`. Returns the first row with a range whose
  /// digest is not honest(samples, row). std::nullopt: all digests are right.
  template <class Honest>
  std::optional<std::uint32_t> wrong_row(std::uint64_t end, Honest honest) const {
    for (const auto& [row, parts] : rows_) {
      for (const auto& [samples, part] : parts) {
        if (samples.first < end && part.digest != honest(samples, row)) {
          return row;
        }
      }
    }
    return std::nullopt;
  }

 private:
  /// The samples of one range in one row.
  struct Part {
    std::uint64_t process = 0;
    std::uint64_t digest = 0;
  };
  std::map<std::uint32_t, std::map<SampleRange, Part>> rows_;
  std::set<std::uint64_t> retracted_;  ///< processes that were retracted
};

}  // namespace bandsaw::coordinator::sim
