// Stores cumulative sums of the weights: one list over the rows, and one list over the columns of
// each row. Sampling searches the row, then the column.

#include "renderlib/sampling/grid_distribution.h"

#include <algorithm>
#include <cstddef>

#include "absl/types/span.h"
#include "renderlib/math/constants.h"

namespace bandsaw {
namespace {

/// A step of a cumulative sum, and the position `rest` within this step, in [0, 1).
struct Step {
  std::size_t index;
  double rest;
};

/// Finds the step of the cumulative sum `ends` that contains `number` times the total; `number` is
/// in [0, 1).
Step invert(absl::Span<const double> ends, double number) {
  const double target = number * ends.back();
  auto end = std::upper_bound(ends.begin(), ends.end(), target);
  // If the product was rounded up to the total, use the last step of non-zero weight.
  if (end == ends.end()) {
    end = std::lower_bound(ends.begin(), ends.end(), ends.back());
  }
  const double before = end == ends.begin() ? 0 : *(end - 1);
  return {static_cast<std::size_t>(end - ends.begin()),
          std::clamp((target - before) / (*end - before), 0.0, kOneMinusEpsilon)};
}

}  // namespace

GridDistribution::GridDistribution(std::uint32_t width, std::uint32_t height,
                                   absl::FunctionRef<double(std::uint32_t, std::uint32_t)> weight)
    : width_(width) {
  row_ends_.reserve(height);
  column_ends_.reserve(std::size_t{width} * height);
  double sum = 0;
  for (std::uint32_t row = 0; row < height; ++row) {
    double row_sum = 0;
    for (std::uint32_t column = 0; column < width; ++column) {
      row_sum += weight(column, row);
      column_ends_.push_back(row_sum);
    }
    sum += row_sum;
    row_ends_.push_back(sum);
  }
}

GridDistribution::Cell GridDistribution::sample(double u, double v) const {
  const Step row = invert(row_ends_, v);
  const auto columns = absl::MakeConstSpan(column_ends_).subspan(row.index * width_, width_);
  const Step column = invert(columns, u);
  return {static_cast<std::uint32_t>(column.index), static_cast<std::uint32_t>(row.index),
          column.rest, row.rest};
}

}  // namespace bandsaw
