#include "coordinator/core/row_times.h"

#include "renderlib/render/tile_mask.h"

namespace bandsaw::coordinator {
namespace {

/// The weight of a new measurement: of two, both count alike.
constexpr float kNewest = 0.5F;

}  // namespace

void RowTimes::measure(const RowRange& rows, double seconds) {
  const auto each = static_cast<float>(seconds / rows.count());
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    float& known = rows_[row];
    const bool is_new = known == kUnknown;
    const float now = is_new ? each : known + kNewest * (each - known);
    sum_ += now - (is_new ? 0 : known);
    rows_known_ += is_new ? 1 : 0;
    known = now;
  }
}

double RowTimes::of(const RowRange& rows, absl::Span<const float> shares) const {
  const double mean = measured() ? sum_ / rows_known_ : 0;
  double sum = 0;
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    const double one = rows_[row] == kUnknown ? mean : rows_[row];
    sum += shares.empty() ? one : one * shares[row / kTileSide];
  }
  return sum;
}

}  // namespace bandsaw::coordinator
