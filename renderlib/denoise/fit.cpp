#include "renderlib/denoise/fit.h"

#include <algorithm>
#include <cstdint>

#include "renderlib/denoise/fit_parts.h"

namespace bandsaw {
namespace {

constexpr int kNear = 2;  ///< a pixel takes its value from centres up to this far away
constexpr int kNearSide = 2 * kNear + 1;
constexpr std::size_t kNearOffsets = kNearSide * kNearSide;
constexpr std::size_t kCoefficients = 3 * kTerms;  ///< of one half
constexpr float kOwnWeight = 0.05f;  ///< of a pixel's own value beside those of the centres

/// Values per centre: planes with one float for each centre.
class CentrePlanes {
 public:
  CentrePlanes(std::size_t planes, int columns, int rows)
      : columns_(columns + kMargin + kTileColumns),
        rows_(rows + kMargin + kTileRows),
        data_(planes * static_cast<std::size_t>(columns_ * rows_), 0.0f) {}
  float* row(std::size_t plane, int row) { return data_.data() + start(plane, row); }
  const float* row(std::size_t plane, int row) const { return data_.data() + start(plane, row); }

 private:
  static constexpr int kMargin = 2;  ///< centres above and to the left, whose weights are zero
  std::ptrdiff_t start(std::size_t plane, int row) const {
    return (static_cast<std::ptrdiff_t>(plane) * rows_ + row + kMargin) * columns_ + kMargin;
  }
  std::ptrdiff_t columns_;
  std::ptrdiff_t rows_;
  HugeVector<float> data_;
};

/// The fitted functions of all centres.
struct Models {
  Models(int columns, int rows)
      : coefficients(2 * kCoefficients, columns, rows), weights(2 * kNearOffsets, columns, rows) {}

  static std::size_t coefficient(std::size_t half, std::size_t term, std::size_t channel) {
    return half * kCoefficients + term * 3 + channel;
  }
  static std::size_t weight(std::size_t half, int dx, int dy) {
    return half * kNearOffsets + static_cast<std::size_t>((dy + kNear) * kNearSide + dx + kNear);
  }
  CentrePlanes coefficients;
  CentrePlanes weights;  ///< of the pixels up to kNear away
};

class TileFit {
 public:
  TileFit(const FitInput& input, const FitSettings& settings, Models& models)
      : input_(input),
        settings_(settings),
        models_(models),
        distances_{PatchDistances(input, 0), PatchDistances(input, 1)} {}

  /// Fits the centres of the tile whose first centre is (column, row).
  void run(int column, int row) {
    distances_[0].compute(2 * column, 2 * row);
    distances_[1].compute(2 * column, 2 * row);
    for (int j = 0; j < kTileRows && 2 * (row + j) < input_.height; ++j) {
      for (int i = 0; i < kTileColumns && 2 * (column + i) < input_.width; i += kFitLanes) {
        fit_centres(column + i, row + j, i, j);
      }
    }
  }

 private:
  /// Fits eight centres: column i of row j in the tile.
  void fit_centres(int column, int row, int i, int j);
  /// Returns the factor of a pixel's weight by its guides' differences from those of the centre.
  Float8 similarity(const Float8* differences, const Float8& depth_scale) const;

  const FitInput& input_;
  const FitSettings& settings_;
  Models& models_;
  PatchDistances distances_[2];
};

Float8 TileFit::similarity(const Float8* d, const Float8& depth_scale) const {
  const auto per_square = [](float reach) { return Float8(1.0f / (reach * reach)); };
  const Float8 albedo = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  const Float8 normal = d[3] * d[3] + d[4] * d[4];
  const Float8 depth = d[kDepthGuide] * depth_scale;
  return falling(
      (albedo * per_square(settings_.albedo_reach) + normal * per_square(settings_.normal_reach)) +
      depth * depth);
}

void TileFit::fit_centres(int column, int row, int i, int j) {
  const int y = 2 * row;
  Float8 centre[kGuides];
  for (std::size_t g = 0; g < kGuides; ++g) {
    centre[g] = Float8::load(input_.guides[g].row(0, y) + column);
  }
  const Float8 depth_scale =
      Float8(1.0f) / (max(centre[kDepthGuide], Float8(1e-6f)) * Float8(settings_.depth_reach));
  const Float8 per_reach(1.0f / (settings_.color_reach * settings_.color_reach));
  NormalEquations equations[2];
  for (int dy = -kFitRadius; dy <= kFitRadius; ++dy) {
    for (int dx = -kFitRadius; dx <= kFitRadius; ++dx) {
      const int parity = dx & 1;
      const int at = column + (dx >> 1);
      Float8 terms[kTerms] = {Float8(1.0f), Float8(static_cast<float>(dx) / kFitRadius),
                              Float8(static_cast<float>(dy) / kFitRadius)};
      for (std::size_t g = 0; g < kGuides; ++g) {
        terms[3 + g] = Float8::load(input_.guides[g].row(parity, y + dy) + at) - centre[g];
      }
      const Float8 similar =
          similarity(terms + 3, depth_scale) * Float8::load(input_.valid.row(parity, y + dy) + at);
      for (std::size_t h = 0; h < 2; ++h) {
        const Float8 distance = Float8::load(distances_[1 - h].to(dx, dy, j, i));
        const Float8 weight = similar * falling(distance * per_reach);
        if (std::max(std::abs(dx), std::abs(dy)) <= kNear) {
          weight.store(models_.weights.row(Models::weight(h, dx, dy), row) + column);
        }
        Float8 value[3];
        for (std::size_t c = 0; c < 3; ++c) {
          value[c] = Float8::load(input_.halves[h][c].row(parity, y + dy) + at);
        }
        equations[h].add(weight, terms, value);
      }
    }
  }
  for (std::size_t h = 0; h < 2; ++h) {
    equations[h].add_ridge();
    equations[h].solve();
    for (std::size_t t = 0; t < kTerms; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        equations[h].values[t][c].store(
            models_.coefficients.row(Models::coefficient(h, t, c), row) + column);
      }
    }
  }
}

/// Evaluates the models at the pixels of rows.
class Evaluation {
 public:
  Evaluation(const FitInput& input, const Models& models, FitOutput& output)
      : input_(input), models_(models), output_(output) {}

  void run(int y) {
    for (int parity = 0; parity < 2; ++parity) {
      for (int i = 0; 2 * i < input_.width; i += kFitLanes) {
        evaluate(i, parity, y);
      }
    }
  }

 private:
  struct Sums {
    Float8 values[2][3];
    Float8 weights[2];
  };
  /// Adds the models of the centres at column i + k and row cy / 2, for pixels at (dx, dy) from
  /// them.
  void add_centres(int i, int parity, int y, int k, int cy, Sums& sums) const;
  void evaluate(int i, int parity, int y);

  const FitInput& input_;
  const Models& models_;
  FitOutput& output_;
};

void Evaluation::add_centres(int i, int parity, int y, int k, int cy, Sums& sums) const {
  const int dx = parity - 2 * k;
  const int dy = y - cy;
  Float8 terms[kTerms] = {Float8(1.0f), Float8(static_cast<float>(dx) / kFitRadius),
                          Float8(static_cast<float>(dy) / kFitRadius)};
  for (std::size_t g = 0; g < kGuides; ++g) {
    terms[3 + g] = Float8::load(input_.guides[g].row(parity, y) + i) -
                   Float8::load(input_.guides[g].row(0, cy) + i + k);
  }
  for (std::size_t h = 0; h < 2; ++h) {
    const Float8 weight =
        Float8::load(models_.weights.row(Models::weight(h, dx, dy), cy / 2) + i + k);
    for (std::size_t c = 0; c < 3; ++c) {
      Float8 value(0.0f);
      for (std::size_t t = 0; t < kTerms; ++t) {
        const float* const of =
            models_.coefficients.row(Models::coefficient(h, t, c), cy / 2) + i + k;
        value = value + Float8::load(of) * terms[t];
      }
      sums.values[h][c] = sums.values[h][c] + weight * value;
    }
    sums.weights[h] = sums.weights[h] + weight;
  }
}

void Evaluation::evaluate(int i, int parity, int y) {
  Sums sums;
  for (std::size_t h = 0; h < 2; ++h) {
    // Where no centre resembles the pixel, its own value is left.
    const Float8 own = Float8(kOwnWeight) * Float8::load(input_.valid.row(parity, y) + i);
    sums.weights[h] = own + Float8(1e-12f);
    for (std::size_t c = 0; c < 3; ++c) {
      sums.values[h][c] = own * Float8::load(input_.halves[h][c].row(parity, y) + i);
    }
  }
  for (int cy = std::max(0, y - kNear + (y & 1)); cy <= std::min(y + kNear, input_.height - 1);
       cy += 2) {
    for (int k = parity == 0 ? -1 : 0; k <= 1; ++k) {
      add_centres(i, parity, y, k, cy, sums);
    }
  }
  const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(input_.width);
  for (std::size_t h = 0; h < 2; ++h) {
    for (std::size_t c = 0; c < 3; ++c) {
      float lanes[kFitLanes];
      max(sums.values[h][c] / sums.weights[h], Float8(0.0f)).store(lanes);
      for (int lane = 0; lane < kFitLanes && 2 * (i + lane) + parity < input_.width; ++lane) {
        output_.halves[h][c][row + static_cast<std::size_t>(2 * (i + lane) + parity)] = lanes[lane];
      }
    }
  }
}

}  // namespace

FitOutput fit(const FitInput& input, const FitSettings& settings, Pool& pool) {
  const int columns = (input.width + 1) / 2;
  const int rows = (input.height + 1) / 2;
  Models models(columns, rows);
  const int across = (columns + kTileColumns - 1) / kTileColumns;
  const int down = (rows + kTileRows - 1) / kTileRows;
  pool.parallel_for(std::int64_t{across} * down, [&](std::int64_t tile) {
    TileFit(input, settings, models)
        .run(static_cast<int>(tile % across) * kTileColumns,
             static_cast<int>(tile / across) * kTileRows);
  });
  FitOutput output;
  for (auto& half : output.halves) {
    for (auto& channel : half) {
      channel.resize(static_cast<std::size_t>(input.width) *
                     static_cast<std::size_t>(input.height));
    }
  }
  pool.parallel_for(input.height, [&](std::int64_t y) {
    Evaluation(input, models, output).run(static_cast<int>(y));
  });
  return output;
}

}  // namespace bandsaw
