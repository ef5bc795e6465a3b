#include "renderlib/render/adaptive_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// No half tile is planned for more than so many times the mean: a plan that a few dominate is
/// drawn out over many passes in which most of the machines have little to do.
constexpr double kMostOverMean = 8;
/// What a tile itself says counts as much as all tiles around: they make it surer.
constexpr double kOwnTile = 0.5;
/// The gain in error at equal samples below which a plan is not worth having: a sample where noise
/// is takes 1.1 to 1.4 times the time of others (tests/bench/README.md).
constexpr double kLeastGain = 1.25;
/// A plan is judged by what it comes to after so many times the pilot's samples.
constexpr double kJudgedAfter = 8;

constexpr int kLevels = 16;

int level_of_digit(char digit) { return digit <= '9' ? digit - '0' : digit - 'a' + 10; }
char digit_of(int level) { return "0123456789abcdef"[level]; }

/// 2^((6 - level) / 2).
double share_of(int level) {
  constexpr double kRoot = 0.70710678118654752440;
  double share = 8;
  for (int i = 0; i < level; ++i) {
    share *= kRoot;
  }
  return share;
}

int level_of(double share) {
  int level = 0;
  while (level + 1 < kLevels && share * share < share_of(level) * share_of(level + 1)) {
    ++level;
  }
  return level;
}

/// Means over pixels.
class Mean {
 public:
  void add(const TileError& tile) {
    pixels_ += tile.pixels;
    variance_ += tile.pixels * tile.variance;
    relative_ += tile.pixels * tile.relative;
  }
  /// Of all of them together.
  TileError value() const {
    return pixels_ > 0 ? TileError{pixels_, variance_ / pixels_, relative_ / pixels_} : TileError{};
  }

 private:
  std::uint32_t pixels_ = 0;
  double variance_ = 0;
  double relative_ = 0;
};

/// One a tile. The same for all would be their root mean square: then the last sample of a tile
/// takes off as much of the error as the last of one that is dealt out to evenly, in the other half
/// of the image, say, where it is the root of the mean variance that counts.
std::vector<int> levels_of(std::vector<double> weights) {
  const auto count = static_cast<double>(weights.size());
  const double most = kMostOverMean * std::accumulate(weights.begin(), weights.end(), 0.0) / count;
  double squares = 0;
  for (double& weight : weights) {
    weight = std::min(weight, most);
    squares += weight * weight;
  }
  const double even = std::sqrt(squares / count);
  std::vector<int> levels;
  for (const double weight : weights) {
    levels.push_back(even > 0 ? level_of(weight / even) : level_of(1));
  }
  return levels;
}

/// What some pixels of every tile say.
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

  /// How samples are dealt out to the tiles.
  std::vector<int> levels() const {
    std::vector<double> weights;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      weights.push_back(weight(here(i)));
    }
    return levels_of(std::move(weights));
  }

 private:
  /// By which samples are dealt out to a tile whose errors are these.
  double weight(const TileError& tile) const {
    return std::sqrt((mean_.variance > 0 ? tile.variance / mean_.variance : 0) +
                     (mean_.relative > 0 ? tile.relative / mean_.relative : 0));
  }
  /// The errors of the tiles around tile i; of all tiles where there are none.
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
  /// The same with the tile itself.
  TileError here(std::size_t i) const {
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

/// By how much the larger of the two errors falls below that of as many samples dealt out evenly,
/// where each half of the rows is dealt out to as the other shows.
double gain(const std::array<Pilot, 2>& rows) {
  double samples = 0;
  Mean evenly;
  Mean planned;
  for (const std::size_t half : {0, 1}) {
    const std::vector<int> levels = rows[1 - half].levels();
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const TileError& tile = rows[half].tiles()[i];
      const double times = std::max(1.0, kJudgedAfter * share_of(levels[i]));
      evenly.add(tile);
      planned.add({tile.pixels, tile.variance / times, tile.relative / times});
      samples += times * tile.pixels;
    }
  }
  const TileError before = evenly.value();
  const TileError after = planned.value();
  const auto fall = [&](double from, double to) {
    return from > 0 ? from / to / (samples / before.pixels) : 1;
  };
  return std::min(fall(before.variance, after.variance), fall(before.relative, after.relative));
}

/// Of the tiles, as this half of them shows.
std::vector<int> plan_by(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                         std::size_t half) {
  std::vector<TileError> all;
  std::array<std::vector<TileError>, 2> rows;
  for (std::size_t i = half; i < tiles.size(); i += 2) {
    Mean mean;
    for (const std::size_t parity : {0, 1}) {
      mean.add(tiles[i][parity]);
      rows[parity].push_back(tiles[i][parity]);
    }
    all.push_back(mean.value());
  }
  const bool pays =
      gain({Pilot(grid, std::move(rows[0])), Pilot(grid, std::move(rows[1]))}) >= kLeastGain;
  return pays ? Pilot(grid, std::move(all)).levels() : std::vector<int>(all.size(), level_of(1));
}

}  // namespace

TilePlan plan_tiles(const TileGrid& grid, absl::Span<const HalfTileErrors> tiles,
                    std::uint64_t samples) {
  BANDSAW_CHECK(tiles.size() == grid.half_tiles(), "one error a half tile");
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
