#pragma once

// Adaptive sampling: more samples for pixels with more noise, without bias.
//
// A rule that decides from a pixel's own samples whether the pixel needs further samples is biased,
// because it stops pixels that happened to see little light: a pixel lit by one of a hundred
// samples can converge to 14 % of its value. Here a pixel's own samples never decide how many
// samples it gets. The first samples of all pixels are a pilot. A fixed pattern divides the pixels
// of every tile into an even and an odd half (tile_samples.h). After the pilot, the number of
// samples is planned once. The plan for the even half of every tile uses the pilot of the image's
// odd pixels alone, and the plan for the odd half uses the pilot of the even pixels. The Owen
// scrambles of different pixels are independent (sampling/sampler.h). So, given the plan, a pixel's
// value is the mean of all its samples and unbiased.
//
// Samples are distributed for two errors at once: the mean squared error, which --error bounds, and
// the mean of squared errors over squared values (relMSE), which corresponds to visible noise in
// dark regions. For a single error the optimal allocation is proportional to the standard deviation
// of one sample (Neyman 1934, "On the Two Different Aspects of the Representative Method"). For
// both errors it is proportional to the square root of the sum of the two variances, each divided
// by its mean over the image.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// Error of the pilot over some pixels of a tile: means over the pixels and their channels.
struct TileError {
  std::uint32_t pixels = 0;  ///< may be 0 at the edge of an image
  double variance = 0;       ///< variance of the pilot's mean, >= 0
  double relative = 0;       ///< variance / (value^2 + 0.01)
};

/// Errors of a half tile. Its pixels form numbered groups, in which pixels may share paths
/// (render/pixel_groups.h). Entry 0 is for the pixels in groups with even numbers, and entry 1 is
/// for the pixels in groups with odd numbers. The two errors are independent.
using HalfTileErrors = std::array<TileError, 2>;

/// The level of a half tile that gets as many samples as with uniform sampling. The name does not
/// refer to the even half of a tile.
inline constexpr char kEvenLevel = '6';

/// Sample allocation of each half tile (half of the pixels of a tile, tile_samples.h) after the
/// pilot.
struct TilePlan {
  std::uint64_t pilot = 0;  ///< number of samples that the pilot takes of each pixel
  /// One digit 0 to f for each half tile, in the order of TileGrid. Level l gives 2^((6 - l) / 2)
  /// times the samples of uniform sampling, but at least the pilot's.
  std::string levels;

  /// Returns true if sampling is uniform, that is, if all half tiles have the level kEvenLevel.
  bool even() const { return levels.find_first_not_of(kEvenLevel) == std::string::npos; }
  friend bool operator==(const TilePlan&, const TilePlan&) = default;
};

/// Computes the plan from the pilot. `tiles` has one entry for each half tile; `samples` is the
/// number of samples that the pilot took of each pixel. The function is pure and has the same
/// result on every machine.
///
/// The pilot itself decides whether the plan is worthwhile. For this test, a plan is made from
/// entry 0 of HalfTileErrors and evaluated on the errors of entry 1, and vice versa. If one of the
/// resulting errors (absolute or relative) is not well below that of uniform sampling with as many
/// samples, all levels in the planned half of the image are 6.
TilePlan plan_tiles(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                    std::uint64_t samples);

/// Returns the factor of the half tile's level, 2^-4.5 to 8: the number of its samples divided by
/// the number that uniform sampling would give it. The function ignores that a half tile has at
/// least the pilot's samples.
double share_of(const TilePlan& plan, std::size_t half_tile);

}  // namespace bandsaw
