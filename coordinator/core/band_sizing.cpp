#include "coordinator/core/band_sizing.h"

#include <algorithm>

#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

/// The first band of a worker, and the shortest at the end, as parts of the target.
constexpr double kFirst = 0.2;
constexpr double kShortest = 0.125;

constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(double);

}  // namespace

std::uint32_t most_rows(std::uint32_t width) {
  return static_cast<std::uint32_t>(
      std::max<std::uint64_t>(1, wire::kBandBytes / (width * kBytesPerPixel)));
}

Band size_band(const Sizing& sizing) {
  Band band = sizing.free;
  const double full = sizing.pace * sizing.target_s;
  const double first_row = sizing.cost->of({band.rows.first, band.rows.first + 1}, sizing.shares) *
                           static_cast<double>(sizing.width);
  while (static_cast<double>(band.samples.samples()) * first_row > 2 * full &&
         band.samples.blocks() > 1) {
    band.samples = split(band.samples).left;
  }
  if (band.samples != sizing.free.samples) {
    band.rows.last = band.rows.first + 1;
    return band;
  }
  const double guided = sizing.left * sizing.share / 2;
  const double want =
      std::min(full * (sizing.measured ? 1 : kFirst), std::max(guided, full * kShortest));
  const std::uint32_t fitting = sizing.cost->fitting(
      band.rows, want / (static_cast<double>(band.samples.samples()) * sizing.width),
      sizing.shares);
  band.rows.last = band.rows.first + std::min(fitting, most_rows(sizing.width));
  return band;
}

}  // namespace bandsaw::coordinator
