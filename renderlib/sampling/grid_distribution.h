#pragma once

// Piecewise-constant 2D distribution, used for environment maps: samples a cell of a grid in
// proportion to its weight, first the row by its marginal, then the column. Both steps invert a
// cumulative sum, which preserves stratification (Pharr, Jakob and Humphreys, "Physically Based
// Rendering", A.5.3). Sums are double, so that a tail of small weights keeps its probability.

#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"

namespace bandsaw {

class GridDistribution {
 public:
  struct Cell {
    std::uint32_t column = 0;
    std::uint32_t row = 0;
    double u = 0;  ///< remainder of the random number for the column, rescaled to [0, 1)
    double v = 0;  ///< remainder of the random number for the row, rescaled to [0, 1)
  };

  GridDistribution() = default;
  /// `weight(column, row)` must be finite and >= 0. Stores 8 bytes per cell.
  GridDistribution(std::uint32_t width, std::uint32_t height,
                   absl::FunctionRef<double(std::uint32_t, std::uint32_t)> weight);

  /// Returns the sum of all weights.
  double total() const { return row_ends_.empty() ? 0 : row_ends_.back(); }
  /// Samples a cell; u, v in [0, 1). total() MUST be > 0. Cells of weight 0 are never returned.
  Cell sample(double u, double v) const;

 private:
  std::uint32_t width_ = 0;
  std::vector<double> row_ends_;     ///< cumulative sum over the rows
  std::vector<double> column_ends_;  ///< for each row, cumulative sum over its columns
};

}  // namespace bandsaw
