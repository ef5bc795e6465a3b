#pragma once

// How long the rows of one image took, in seconds of a thread, for telling the time that is left.
// Beside the cost map, whose scale drifts and whose rows are half guessed: here every number was
// measured, and what was not lies between its neighbours.

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
  bool measured() const { return measured_; }

  /// Of one sample in one column, summed over the rows; `shares` as the cost map takes them.
  double of(const RowRange& rows, absl::Span<const float> shares = {}) const;
  double of_all() const { return of({0, static_cast<std::uint32_t>(rows_.size())}); }

 private:
  static constexpr float kUnknown = -1;
  /// Rows that nobody has measured, and what the nearest that somebody has took.
  struct Gap {
    RowRange rows;
    double before = 0;
    double after = 0;
    double of(std::uint32_t row) const {
      return before + (after - before) * (row - rows.first + 1) / (rows.count() + 1);
    }
  };
  /// Around an unknown row, while some row is known.
  Gap gap_at(std::uint32_t row) const;

  std::vector<float> rows_;
  bool measured_ = false;
};

}  // namespace bandsaw::coordinator
