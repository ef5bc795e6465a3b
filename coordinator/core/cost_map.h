#pragma once

// What the rows of one image cost, measured from the bands that came back: a band's time on its
// worker is its rows' cost over that worker's pace. Only ratios mean anything; before anything is
// measured every row costs 1.

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

class CostMap {
 public:
  CostMap() = default;
  /// height > 0
  explicit CostMap(std::uint32_t height);

  /// Of one sample in one column, summed over the rows, in a pass in which the pixels of a tile row
  /// take so many times as many samples as evenly (one number a tile row of the image; none: 1).
  double of(const RowRange& rows, absl::Span<const float> shares = {}) const;
  double of_all() const { return of({0, static_cast<std::uint32_t>(rows_.size())}); }
  /// How many rows from the first of these cost no more than `most`; at least one.
  std::uint32_t fitting(const RowRange& rows, double most,
                        absl::Span<const float> shares = {}) const;

  /// The rows took `ratio` times as long as was expected of them.
  void learn(const RowRange& rows, double ratio);

 private:
  static constexpr std::uint32_t kGroup = 64;
  float of_row(std::uint32_t row, absl::Span<const float> shares) const;
  double add(std::uint32_t first, std::uint32_t last, absl::Span<const float> shares) const;

  std::vector<float> rows_;
  std::vector<double> groups_;  ///< sums over kGroup rows each
};

}  // namespace bandsaw::coordinator
