#include "coordinator/core/row_times.h"

#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {
namespace {

/// The weight of a new measurement: of two, both count alike.
constexpr float kNewest = 0.5F;

}  // namespace

void RowTimes::measure(const RowRange& rows, double seconds) {
  const auto each = static_cast<float>(seconds / rows.count());
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    float& known = rows_[row];
    known = known == kUnknown ? each : known + kNewest * (each - known);
  }
  measured_ = true;
}

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

double RowTimes::of(const RowRange& rows, absl::Span<const float> shares) const {
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
    sum += shares.empty() ? one : one * shares[row / kTileSide];
  }
  return sum;
}

}  // namespace bandsaw::coordinator
