// Sums of the rows' costs are kept for groups of 64 rows, so that the cost of a long range is found
// quickly. Times of rows without a measurement are interpolated between measured ones.

#include "coordinator/scheduler/model/row_costs.h"

#include <algorithm>
#include <cmath>

#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {
namespace {

/// Bounds of the ratio that one measurement can have, and of the cost of a row: a single wrong time
/// must not make the cost of a row 0 or infinite.
constexpr double kMaxRatio = 16;
constexpr float kMinCost = 1e-6f;
constexpr float kMaxCost = 1e6f;

/// Weight of a new measurement against all earlier ones of the row.
constexpr float kWeight = 0.5F;

}  // namespace

CostMap::CostMap(std::uint32_t height) : rows_(height, 1) {
  for (std::uint32_t first = 0; first < height; first += kGroup) {
    groups_.push_back(std::min(kGroup, height - first));
  }
}

float CostMap::of_row(std::uint32_t row, absl::Span<const float> tile_row_shares) const {
  return tile_row_shares.empty() ? rows_[row] : rows_[row] * tile_row_shares[row / kTileSide];
}

double CostMap::add(std::uint32_t first, std::uint32_t last,
                    absl::Span<const float> tile_row_shares) const {
  double sum = 0;
  for (std::uint32_t row = first; row < last; ++row) {
    sum += of_row(row, tile_row_shares);
  }
  return sum;
}

// Adds the sums of the groups [whole, after), which lie completely in the range, and the costs of
// the other rows one by one. The sums of groups hold for uniform sampling only.
double CostMap::of(const RowRange& rows, absl::Span<const float> tile_row_shares) const {
  const std::uint32_t whole = (rows.first + kGroup - 1) / kGroup;
  const std::uint32_t after = rows.last / kGroup;
  if (whole >= after || !tile_row_shares.empty()) {
    return add(rows.first, rows.last, tile_row_shares);
  }
  double sum = add(rows.first, whole * kGroup, {}) + add(after * kGroup, rows.last, {});
  for (std::uint32_t group = whole; group < after; ++group) {
    sum += groups_[group];
  }
  return sum;
}

std::uint32_t CostMap::fitting(const RowRange& rows, double max_cost,
                               absl::Span<const float> tile_row_shares) const {
  double sum = of_row(rows.first, tile_row_shares);
  std::uint32_t row = rows.first + 1;
  while (row < rows.last && sum + of_row(row, tile_row_shares) <= max_cost) {
    sum += of_row(row++, tile_row_shares);
  }
  return row - rows.first;
}

void CostMap::learn(const RowRange& rows, double ratio) {
  const auto factor =
      static_cast<float>(std::pow(std::clamp(ratio, 1 / kMaxRatio, kMaxRatio), 0.75));
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    rows_[row] = std::clamp(rows_[row] * factor, kMinCost, kMaxCost);
  }
  const auto height = static_cast<std::uint32_t>(rows_.size());
  for (std::uint32_t group = rows.first / kGroup; group * kGroup < rows.last; ++group) {
    groups_[group] = add(group * kGroup, std::min(height, (group + 1) * kGroup), {});
  }
}

void RowTimes::measure(const RowRange& rows, double seconds) {
  const auto each = static_cast<float>(seconds / rows.count());
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    float& known = rows_[row];
    known = known == kUnknown ? each : known + kWeight * (each - known);
  }
  measured_ = true;
}

// A gap at the upper or lower edge of the image has a measured row on one side only. The time of
// that row is used for both sides.
RowTimes::Gap RowTimes::gap_at(std::uint32_t row) const {
  Gap gap{{row, row + 1}};
  while (gap.rows.first > 0 && rows_[gap.rows.first - 1] == kUnknown) {
    --gap.rows.first;
  }
  while (gap.rows.last < rows_.size() && rows_[gap.rows.last] == kUnknown) {
    ++gap.rows.last;
  }
  const bool top = gap.rows.first == 0;
  const bool bottom = gap.rows.last == rows_.size();
  gap.before = rows_[top ? gap.rows.last : gap.rows.first - 1];
  gap.after = rows_[bottom ? gap.rows.first - 1 : gap.rows.last];
  return gap;
}

double RowTimes::of(const RowRange& rows, absl::Span<const float> tile_row_shares) const {
  if (!measured_) {
    return 0;
  }
  double sum = 0;
  Gap gap{{0, 0}};
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    const bool known = rows_[row] != kUnknown;
    if (!known && row >= gap.rows.last) {
      gap = gap_at(row);
    }
    const double one = known ? rows_[row] : gap.of(row);
    sum += tile_row_shares.empty() ? one : one * tile_row_shares[row / kTileSide];
  }
  return sum;
}

}  // namespace bandsaw::coordinator
