// Plans how many samples each half tile gets. A half tile is one half of the pixels of a tile
// (tile_samples.h). The plan is made from the errors of the pilot, the first samples of all pixels.
// An object of the class Pilot holds the pilot's errors over some of the pixels, and suggests a
// level for each tile. The level stands for a factor on the tile's number of samples. gain()
// evaluates the suggestion on the errors of other pixels.

#include "renderlib/render/adaptive_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// Maximum weight of a half tile, as a multiple of the mean weight. Without this limit a few half
/// tiles could get most of the samples. Such a plan takes many passes in which most machines have
/// little to do.
constexpr double kMaxOverMean = 8;
/// The error that is used for a tile is kOwnTile times its own error plus (1 - kOwnTile) times the
/// mean error of its neighbours. The neighbours reduce the noise of the estimate.
constexpr double kOwnTile = 0.5;
/// Minimum gain in error at equal samples for which a plan is worthwhile. It is larger than 1,
/// because samples in noisy regions take 1.1 to 1.4 times the time of others
/// (tests/bench/README.md).
constexpr double kMinGain = 1.25;
/// The gain of a plan is predicted for images with this many times the samples of the pilot.
constexpr double kJudgedAfter = 8;

constexpr int kLevels = 16;

// Levels are written as hexadecimal digits.
int level_of_digit(char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; }
char digit_of(int level) { return "0123456789abcdef"[level]; }

/// Returns the factor of a level, 2^((6 - level) / 2).
double share_of(int level) {
  constexpr double kRoot = 0.70710678118654752440;
  double share = 8;
  for (int i = 0; i < level; ++i) {
    share *= kRoot;
  }
  return share;
}

/// Returns the level whose factor is closest to `share`, by ratio.
int level_of(double share) {
  int level = 0;
  while (level + 1 < kLevels && share * share < share_of(level) * share_of(level + 1)) {
    ++level;
  }
  return level;
}

/// Mean errors, weighted by pixels.
class Mean {
 public:
  void add(const TileError& tile) {
    pixels_ += tile.pixels;
    variance_ += tile.pixels * tile.variance;
    relative_ += tile.pixels * tile.relative;
  }
  /// Returns the mean over all tiles added.
  TileError value() const {
    return pixels_ > 0 ? TileError{pixels_, variance_ / pixels_, relative_ / pixels_} : TileError{};
  }

 private:
  std::uint32_t pixels_ = 0;
  double variance_ = 0;
  double relative_ = 0;
};

/// Returns the level of each tile, given the weight of each tile. The factor of a tile is its
/// weight (at most kMaxOverMean times the mean) divided by the root mean square of all weights. It
/// is rounded to the factor of a level. The divisor makes planned tiles comparable with tiles that
/// are sampled uniformly, such as the other half of the image if no plan is made for it: one more
/// sample reduces the error of both by the same amount on average. (For uniform sampling this
/// amount is proportional to the mean variance, that is, to the mean of the squared weights.)
std::vector<int> levels_of(std::vector<double> weights) {
  const auto count = static_cast<double>(weights.size());
  const double most = kMaxOverMean * std::accumulate(weights.begin(), weights.end(), 0.0) / count;
  double squares = 0;
  for (double& weight : weights) {
    weight = std::min(weight, most);
    squares += weight * weight;
  }
  const double root_mean_square = std::sqrt(squares / count);
  std::vector<int> levels;
  for (const double weight : weights) {
    levels.push_back(root_mean_square > 0 ? level_of(weight / root_mean_square) : level_of(1));
  }
  return levels;
}

/// The pilot's errors over some pixels of every tile.
class Pilot {
 public:
  Pilot(const TileGrid& grid, std::vector<TileError> tiles)
      : grid_(grid), tiles_(std::move(tiles)) {
    Mean mean;
    for (const TileError& tile : tiles_) {
      mean.add(tile);
    }
    mean_ = mean.value();
  }

  const std::vector<TileError>& tiles() const { return tiles_; }

  /// Returns the levels that the errors suggest, one for each tile.
  std::vector<int> levels() const {
    std::vector<double> weights;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      weights.push_back(weight(blended_error(i)));
    }
    return levels_of(std::move(weights));
  }

 private:
  /// Returns the weight of a tile, given its errors.
  double weight(const TileError& tile) const {
    return std::sqrt((mean_.variance > 0 ? tile.variance / mean_.variance : 0) +
                     (mean_.relative > 0 ? tile.relative / mean_.relative : 0));
  }
  /// Returns the mean error of the tiles adjacent to tile i. If the adjacent tiles have no pixels,
  /// returns the mean error of all tiles.
  TileError around(std::size_t i) const {
    const auto row = static_cast<std::uint32_t>(i) / grid_.columns();
    const auto column = static_cast<std::uint32_t>(i) % grid_.columns();
    Mean mean;
    for (std::uint32_t r = row - std::min(row, 1u); r < std::min(row + 2, grid_.rows()); ++r) {
      for (std::uint32_t c = column - std::min(column, 1u);
           c < std::min(column + 2, grid_.columns()); ++c) {
        if (r != row || c != column) {
          mean.add(tiles_[std::size_t{r} * grid_.columns() + c]);
        }
      }
    }
    const TileError value = mean.value();
    return value.pixels > 0 ? value : mean_;
  }
  /// Returns the error of the tile i blended with around(i).
  TileError blended_error(std::size_t i) const {
    const TileError others = around(i);
    const TileError& own = tiles_[i];
    return own.pixels == 0
               ? others
               : TileError{1, kOwnTile * own.variance + (1 - kOwnTile) * others.variance,
                           kOwnTile * own.relative + (1 - kOwnTile) * others.relative};
  }

  TileGrid grid_;
  std::vector<TileError> tiles_;
  TileError mean_;
};

/// Returns the predicted gain of the plan: the error of uniform sampling divided by the error with
/// the plan, at the same number of samples. There are two errors (absolute and relative); the
/// smaller gain is returned. Each of the two parts of the pixels is planned from the errors of the
/// other part.
double gain(const std::array<Pilot, 2>& parts) {
  double samples = 0;
  Mean evenly;
  Mean planned;
  for (const std::size_t part : {0, 1}) {
    const std::vector<int> levels = parts[1 - part].levels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const TileError& tile = parts[part].tiles()[i];
      const double times = std::max(1.0, kJudgedAfter * share_of(levels[i]));
      evenly.add(tile);
      planned.add({tile.pixels, tile.variance / times, tile.relative / times});
      samples += times * tile.pixels;
    }
  }
  const TileError before = evenly.value();
  const TileError after = planned.value();
  // Returns the gain, given the error `from` of the pilot and the error `to` of the plan. The plan
  // takes samples / before.pixels times the samples of the pilot. Uniform sampling with as many
  // samples would have the error `from` divided by this quotient.
  const auto fall = [&](double from, double to) {
    return from > 0 ? from / to / (samples / before.pixels) : 1;
  };
  return std::min(fall(before.variance, after.variance), fall(before.relative, after.relative));
}

/// Returns a level for each tile, planned from the errors of half `half` (0 or 1) of each tile's
/// pixels. All levels are 6 (uniform sampling) if the plan is not worthwhile.
std::vector<int> plan_by(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                         std::size_t half) {
  std::vector<TileError> all;
  std::array<std::vector<TileError>, 2> parts;
  for (std::size_t i = half; i < tiles.size(); i += 2) {
    Mean mean;
    for (const std::size_t part : {0, 1}) {
      mean.add(tiles[i][part]);
      parts[part].push_back(tiles[i][part]);
    }
    all.push_back(mean.value());
  }
  const bool pays =
      gain({Pilot(grid, std::move(parts[0])), Pilot(grid, std::move(parts[1]))}) >= kMinGain;
  return pays ? Pilot(grid, std::move(all)).levels() : std::vector<int>(all.size(), level_of(1));
}

}  // namespace

TilePlan plan_tiles(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                    std::uint64_t samples) {
  BANDSAW_CHECK(tiles.size() == grid.half_tiles(), "there is one entry for each half tile");
  TilePlan plan{.pilot = samples, .levels = std::string(tiles.size(), kEvenLevel)};
  for (const std::size_t half : {0, 1}) {
    const std::vector<int> levels = plan_by(grid, tiles, 1 - half);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      plan.levels[2 * i + half] = digit_of(levels[i]);
    }
  }
  return plan;
}

double share_of(const TilePlan& plan, std::size_t half_tile) {
  return share_of(level_of_digit(plan.levels[half_tile]));
}

}  // namespace bandsaw
