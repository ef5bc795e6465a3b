#pragma once

// Render costs of the rows of one image. CostMap has relative costs, which determine the sizes of
// bands (the parts of an image that workers render). RowTimes has times, from which the end of the
// job is predicted.

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Relative cost of each row, learnt from the bands that were rendered. The render time of a band
/// is predicted as the cost of its rows, divided by its worker's work rate. Only ratios of costs
/// have a meaning. Every row costs 1 until learn() changes its cost.
class CostMap {
 public:
  CostMap() = default;
  /// height > 0
  explicit CostMap(std::uint32_t height);

  /// Returns the cost of the rows for a column that is one pixel wide, with one sample a pixel.
  /// `tile_row_shares` is for adaptive jobs, whose number of samples varies over the image. For
  /// each row of tiles (16 rows of pixels), it has the number of samples that the pixels take,
  /// divided by the number that they would take with uniform sampling; empty: 1 for each.
  double of(const RowRange& rows, absl::Span<const float> tile_row_shares = {}) const;
  double of_all() const { return of({0, static_cast<std::uint32_t>(rows_.size())}); }
  /// Returns how many of the rows, from the first on, cost at most `max_cost` together (in units of
  /// `of`); at least 1.
  std::uint32_t fitting(const RowRange& rows, double max_cost,
                        absl::Span<const float> tile_row_shares = {}) const;

  /// Corrects the costs of rows that took `ratio` times as long as predicted: each cost is
  /// multiplied by ratio^0.75. The rest of the difference is attributed to the worker.
  void learn(const RowRange& rows, double ratio);

 private:
  /// Sums of costs are kept for groups of this many rows, so that `of` is fast.
  static constexpr std::uint32_t kGroup = 64;
  float of_row(std::uint32_t row, absl::Span<const float> tile_row_shares) const;
  /// Returns the same as `of` for rows [first, last), but adds the rows one by one.
  double add(std::uint32_t first, std::uint32_t last,
             absl::Span<const float> tile_row_shares) const;

  std::vector<float> rows_;
  std::vector<double> groups_;  ///< sums over kGroup rows each
};

/// Measured render time of each row. CostMap cannot predict the remaining time of a job: learn()
/// changes the scale of the costs, and the cost of a row that was not rendered yet is a guess.
/// RowTimes has measured times only, and interpolates the times of rows without a measurement.
class RowTimes {
 public:
  /// height > 0
  explicit RowTimes(std::uint32_t height) : rows_(height, kUnknown) {}

  /// Records the time of a column (one pixel wide, one sample in each pixel) of all of `rows`, in
  /// seconds of one thread.
  void measure(const RowRange& rows, double seconds);
  bool measured() const { return measured_; }

  /// Returns the time of a column (one pixel wide, one sample in each pixel) of the rows, in
  /// seconds of one thread; 0 if nothing was measured. `tile_row_shares` as in CostMap::of.
  double of(const RowRange& rows, absl::Span<const float> tile_row_shares = {}) const;
  double of_all() const { return of({0, static_cast<std::uint32_t>(rows_.size())}); }

 private:
  static constexpr float kUnknown = -1;
  /// A run of rows without a measurement, and the times of the measured rows next to it.
  struct Gap {
    RowRange rows;
    double before = 0;
    double after = 0;
    /// Returns the time of a row of the gap, interpolated linearly.
    double of(std::uint32_t row) const {
      return before + (after - before) * (row - rows.first + 1) / (rows.count() + 1);
    }
  };
  /// REQUIRES that `row` has no measurement and some other row has one.
  Gap gap_at(std::uint32_t row) const;

  std::vector<float> rows_;
  bool measured_ = false;
};

}  // namespace bandsaw::coordinator
