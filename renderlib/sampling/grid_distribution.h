#pragma once

// A cell of a grid, chosen in proportion to its weight: the row by the sums of rows, the column by
// the sums within the row, both by inverting the running sum, which keeps stratification (Pharr,
// Jakob, Humphreys, "Physically Based Rendering", A.5.3). Sums are double: a tail of small weights
// is still chosen as often as it should be.

#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"

namespace bandsaw {

class GridDistribution {
 public:
  struct Cell {
    std::uint32_t column = 0;
    std::uint32_t row = 0;
    double u = 0;  ///< what is left of the numbers that chose, in [0, 1)
    double v = 0;
  };

  GridDistribution() = default;
  /// `weight(column, row)` is finite and >= 0. Keeps 8 bytes a cell.
  GridDistribution(std::uint32_t width, std::uint32_t height,
                   absl::FunctionRef<double(std::uint32_t, std::uint32_t)> weight);

  /// Of all weights.
  double total() const { return row_ends_.empty() ? 0 : row_ends_.back(); }
  /// u, v in [0, 1); total() > 0. Cells without weight are never chosen.
  Cell sample(double u, double v) const;

 private:
  std::uint32_t width_ = 0;
  std::vector<double> row_ends_;     ///< running sum over the rows
  std::vector<double> column_ends_;  ///< of each row, running sum over its columns
};

}  // namespace bandsaw
