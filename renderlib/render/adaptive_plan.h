#pragma once

// Adaptive sampling: more samples where there is more noise, without bias.
//
// A rule that looks at a pixel's samples to decide whether it needs more stops where it happened to
// see little, and keeps too little: a pixel lit by one of a hundred samples can come out at 14 % of
// its value. Here nothing that a pixel's samples show decides how many it gets. All pixels take
// part in a pilot, the first samples. Then the even pixels of every tile are planned, once, from
// the pilot of the odd pixels of the image alone, and the odd ones from that of the even ones.
// Scrambles of different pixels are independent (sampling/sampler.h), so given the plan a pixel's
// mean is that of all its samples, and right on average.
//
// Samples are dealt out for two errors at once: the mean of the squared errors, which --error
// promises, and the same over the squared values (relMSE), which is what eyes see in the dark. For
// one of them the best share is the root of the variance of one sample (Neyman 1934, "On the Two
// Different Aspects of the Representative Method", optimum allocation); for both, the root of the
// sum of the two variances, each over its mean over the image.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// What a pilot shows of some pixels: means over them and their channels.
struct TileError {
  std::uint32_t pixels = 0;  ///< 0 at the edge of an image, perhaps
  double variance = 0;       ///< of the pilot's mean, >= 0
  double relative = 0;       ///< the same over value^2 + 0.01
};

/// Of a half tile: of its pixels in even rows of the image, and of those in odd ones.
using HalfTileErrors = std::array<TileError, 2>;

inline constexpr char kEvenLevel = '6';

/// How many samples each half tile is to have after the pilot.
struct TilePlan {
  std::uint64_t pilot = 0;  ///< samples of all pixels
  /// A digit 0 … f a half tile, in the order of TileGrid: of the samples of a half tile that is
  /// dealt out to evenly, level l is to have 2^((6 - l) / 2), but not fewer than the pilot.
  std::string levels;

  /// No tile is to have other samples than another.
  bool even() const { return levels.find_first_not_of(kEvenLevel) == std::string::npos; }
  friend bool operator==(const TilePlan&, const TilePlan&) = default;
};

/// `tiles`: one a half tile, of a pilot of `samples` samples. A pure function, the same on every
/// machine.
///
/// Whether it pays is asked of the pilot itself: what even rows would plan is judged by the noise
/// of odd ones, and the other way round. Where both errors would not fall well below those of as
/// many samples dealt out evenly, every level of a half is 6.
TilePlan plan_tiles(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                    std::uint64_t samples);

/// What this half tile is to have, over the samples of one that is dealt out to evenly.
double share_of(const TilePlan& plan, std::size_t half_tile);

}  // namespace bandsaw
