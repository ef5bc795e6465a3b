#include "coordinator/core/cost_map.h"

#include <algorithm>
#include <cmath>

#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {
namespace {

// One measurement moves a row by so much at most, and no row is ever taken for free.
constexpr double kMostRatio = 16;
constexpr float kLeast = 1e-6f;
constexpr float kMost = 1e6f;

}  // namespace

CostMap::CostMap(std::uint32_t height) : rows_(height, 1) {
  for (std::uint32_t first = 0; first < height; first += kGroup) {
    groups_.push_back(std::min(kGroup, height - first));
  }
}

float CostMap::of_row(std::uint32_t row, absl::Span<const float> shares) const {
  return shares.empty() ? rows_[row] : rows_[row] * shares[row / kTileSide];
}

double CostMap::add(std::uint32_t first, std::uint32_t last, absl::Span<const float> shares) const {
  double sum = 0;
  for (std::uint32_t row = first; row < last; ++row) {
    sum += of_row(row, shares);
  }
  return sum;
}

// The groups' sums are of whole rows.
double CostMap::of(const RowRange& rows, absl::Span<const float> shares) const {
  const std::uint32_t whole = (rows.first + kGroup - 1) / kGroup;
  const std::uint32_t after = rows.last / kGroup;
  if (whole >= after || !shares.empty()) {
    return add(rows.first, rows.last, shares);
  }
  double sum = add(rows.first, whole * kGroup, {}) + add(after * kGroup, rows.last, {});
  for (std::uint32_t group = whole; group < after; ++group) {
    sum += groups_[group];
  }
  return sum;
}

std::uint32_t CostMap::fitting(const RowRange& rows, double most,
                               absl::Span<const float> shares) const {
  double sum = of_row(rows.first, shares);
  std::uint32_t row = rows.first + 1;
  while (row < rows.last && sum + of_row(row, shares) <= most) {
    sum += of_row(row++, shares);
  }
  return row - rows.first;
}

// Most of the difference is put down to the rows (in powers: three quarters); the rest may be the
// worker's.
void CostMap::learn(const RowRange& rows, double ratio) {
  const auto factor =
      static_cast<float>(std::pow(std::clamp(ratio, 1 / kMostRatio, kMostRatio), 0.75));
  for (std::uint32_t row = rows.first; row < rows.last; ++row) {
    rows_[row] = std::clamp(rows_[row] * factor, kLeast, kMost);
  }
  const auto height = static_cast<std::uint32_t>(rows_.size());
  for (std::uint32_t group = rows.first / kGroup; group * kGroup < rows.last; ++group) {
    groups_[group] = add(group * kGroup, std::min(height, (group + 1) * kGroup), {});
  }
}

}  // namespace bandsaw::coordinator
