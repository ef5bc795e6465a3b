#pragma once

// How long the rows of one image took, in seconds of a thread, for telling the time that is left.
// Beside the cost map, whose scale drifts and whose rows are half guessed: here every number was
// measured, and what was not is their mean.

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

class RowTimes {
 public:
  /// height > 0
  explicit RowTimes(std::uint32_t height) : rows_(height, kUnknown) {}

  /// The rows took so long for each sample in one column, together.
  void measure(const RowRange& rows, double seconds);
  bool measured() const { return rows_known_ > 0; }

  /// Of one sample in one column, summed over the rows; `shares` as the cost map takes them.
  double of(const RowRange& rows, absl::Span<const float> shares = {}) const;
  double of_all() const { return of({0, static_cast<std::uint32_t>(rows_.size())}); }

 private:
  static constexpr float kUnknown = -1;

  std::vector<float> rows_;
  double sum_ = 0;  ///< of those that are known
  std::uint32_t rows_known_ = 0;
};

}  // namespace bandsaw::coordinator
