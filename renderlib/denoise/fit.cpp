// Every second pixel of every second row is a centre. TileFit fits a linear function of the
// position and the guides at each centre, eight centres at a time (a Float8 holds one number for
// each). Evaluation then computes each pixel's value from the functions of the centres around it.
//
// The guides are albedo, normal and depth. Even and odd columns of pixels are stored apart
// (split_plane.h): `parity` is 0 for even columns and 1 for odd columns.

#include "renderlib/denoise/fit.h"

#include <algorithm>
#include <cstdint>

#include "renderlib/denoise/fit_parts.h"

namespace bandsaw {
namespace {

constexpr int kNear = 2;  ///< a pixel takes its value from centres up to this far away
constexpr int kNearSide = 2 * kNear + 1;
constexpr std::size_t kNearOffsets = kNearSide * kNearSide;
constexpr std::size_t kCoefficients = 3 * kTerms;  ///< number of coefficients of one half
constexpr float kOwnWeight = 0.05f;  ///< weight of a pixel's own value beside those of the centres

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

/// The fitted functions of one filter at the centres of some rows.
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
  CentrePlanes weights;  ///< weights of the pixels up to kNear away
};

using AllModels = std::array<Models, kFilters>;

/// Fits the functions at the centres of a tile, for both filters (a narrow and a wide one) and for
/// both halves (the images of two independent parts of the samples).
class TileFit {
 public:
  /// `first_row`: the row of centres that is row 0 of the models.
  TileFit(const FitInput& input, const FilterSettings& settings, int first_row, AllModels& models)
      : input_(input),
        settings_(settings),
        first_row_(first_row),
        models_(models),
        distances_{PatchDistances(input, 0), PatchDistances(input, 1)} {}

  /// Fits the centres of the tile whose first centre is (column, row), up to row `last_row`.
  void run(int column, int row, int last_row) {
    distances_[0].compute(2 * column, 2 * row);
    distances_[1].compute(2 * column, 2 * row);
    for (int j = 0; j < kTileRows && row + j < last_row; ++j) {
      for (int i = 0; i < kTileColumns && 2 * (column + i) < input_.width; i += kFitLanes) {
        fit_centres(column + i, row + j, i, j);
      }
    }
  }

 private:
  /// Fits eight centres, of which the first is (column, row). In the tile it is column i of row j.
  void fit_centres(int column, int row, int i, int j);
  /// Solves the equations of both halves and stores the coefficients. `row` is a row of the models.
  void store(int column, int row, std::size_t filter, NormalEquations (&equations)[2]);

  const FitInput& input_;
  const FilterSettings& settings_;
  const int first_row_;
  AllModels& models_;
  PatchDistances distances_[2];
};

Float8 squared(const Float8& value) { return value * value; }

/// Returns the range of a guide, largest minus least value, in the 3 x 3 pixels around each of
/// eight centres, of which the first is (column, row).
Float8 range_around(const SplitPlane& guide, int column, int row) {
  const Float8 zero(0.0f);
  Float8 most(0.0f);
  Float8 most_negated(-1.0f);  // guides are in [0, 1]
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const Float8 value = Float8::load(guide.row(dx & 1, 2 * row + dy) + column + (dx >> 1));
      most = max(most, value);
      most_negated = max(most_negated, zero - value);
    }
  }
  return most + most_negated;
}

/// One over the squares of the reaches of eight centres. A reach is at least the range of the guide
/// around the centre. Otherwise a centre at an edge, whose guides are a mixture of two surfaces,
/// would resemble no other pixel and keep its noise. (Rousselle, Manzi and Zwicker 2013, "Robust
/// Denoising using Feature and Color Information", section 4, use the gradient for the same
/// purpose.)
class GuideReaches {
 public:
  /// The first centre is (column, row), and `centre` has the guides of all eight.
  GuideReaches(const FitInput& input, const FilterSettings& settings, int column, int row,
               const Float8 (&centre)[kGuides]) {
    const Float8 one(1.0f);
    const auto range = [&](std::size_t guide) {
      return squared(range_around(input.guides[guide], column, row));
    };
    const Float8 normal = range(kFirstNormal) + range(kFirstNormal + 1);
    const Float8 depth = range(kDepthGuide);
    for (std::size_t f = 0; f < kFilters; ++f) {
      const FitSettings& of = settings[f];
      per_albedo_[f] = Float8(1.0f / (of.albedo_reach * of.albedo_reach));
      per_normal_[f] = one / max(Float8(of.normal_reach * of.normal_reach), normal);
      const Float8 reach = Float8(of.depth_reach) * max(centre[kDepthGuide], Float8(1e-6f));
      per_depth_[f] = one / max(squared(reach), depth);
    }
  }

  /// Returns the factor in [0, 1] by which the differences `d` of a pixel's guides from those of
  /// the centre reduce its weight in filter `f`.
  Float8 similarity(std::size_t f, const Float8* d) const {
    const Float8 albedo = (squared(d[0]) + squared(d[1])) + squared(d[2]);
    const Float8 normal = squared(d[kFirstNormal]) + squared(d[kFirstNormal + 1]);
    return falling((albedo * per_albedo_[f] + normal * per_normal_[f]) +
                   squared(d[kDepthGuide]) * per_depth_[f]);
  }

 private:
  Float8 per_albedo_[kFilters];
  Float8 per_normal_[kFilters];
  Float8 per_depth_[kFilters];
};

void TileFit::fit_centres(int column, int row, int i, int j) {
  const int y = 2 * row;
  Float8 centre[kGuides];
  for (std::size_t g = 0; g < kGuides; ++g) {
    centre[g] = Float8::load(input_.guides[g].row(0, y) + column);
  }
  const GuideReaches reaches(input_, settings_, column, row, centre);
  Float8 per_reach[kFilters];
  for (std::size_t f = 0; f < kFilters; ++f) {
    per_reach[f] = Float8(1.0f / (settings_[f].color_reach * settings_[f].color_reach));
  }
  NormalEquations equations[kFilters][2];
  for (int dy = -kFitRadius; dy <= kFitRadius; ++dy) {
    for (int dx = -kFitRadius; dx <= kFitRadius; ++dx) {
      const int parity = dx & 1;
      const int at = column + (dx >> 1);
      Float8 terms[kTerms] = {Float8(1.0f), Float8(static_cast<float>(dx) / kFitRadius),
                              Float8(static_cast<float>(dy) / kFitRadius)};
      for (std::size_t g = 0; g < kGuides; ++g) {
        terms[3 + g] = Float8::load(input_.guides[g].row(parity, y + dy) + at) - centre[g];
      }
      const Float8 valid = Float8::load(input_.valid.row(parity, y + dy) + at);
      Float8 similar[kFilters];
      for (std::size_t f = 0; f < kFilters; ++f) {
        similar[f] = reaches.similarity(f, terms + 3) * valid;
      }
      const bool is_near = std::max(std::abs(dx), std::abs(dy)) <= kNear;
      for (std::size_t h = 0; h < 2; ++h) {
        const Float8 distance = Float8::load(distances_[1 - h].to(dx, dy, j, i));
        Float8 value[3];
        for (std::size_t c = 0; c < 3; ++c) {
          value[c] = Float8::load(input_.halves[h][c].row(parity, y + dy) + at);
        }
        for (std::size_t f = 0; f < kFilters; ++f) {
          const Float8 weight = similar[f] * falling(distance * per_reach[f]);
          if (is_near) {
            weight.store(models_[f].weights.row(Models::weight(h, dx, dy), row - first_row_) +
                         column);
          }
          if ((Float8(0.0f) < weight).bits() != 0) {
            equations[f][h].add(weight, terms, value);
          }
        }
      }
    }
  }
  for (std::size_t f = 0; f < kFilters; ++f) {
    store(column, row - first_row_, f, equations[f]);
  }
}

void TileFit::store(int column, int row, std::size_t filter, NormalEquations (&equations)[2]) {
  for (std::size_t h = 0; h < 2; ++h) {
    equations[h].add_ridge();
    equations[h].solve();
    for (std::size_t t = 0; t < kTerms; ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        equations[h].values[t][c].store(
            models_[filter].coefficients.row(Models::coefficient(h, t, c), row) + column);
      }
    }
  }
}

/// Computes the filtered values of rows from the models of one filter.
class Evaluation {
 public:
  /// `first_row`: the row of centres that is row 0 of the models.
  Evaluation(const FitInput& input, int first_row, const Models& models, FitOutput& output)
      : input_(input), first_row_(first_row), models_(models), output_(output) {}

  /// Computes the values of row y.
  void run(int y) {
    for (int parity = 0; parity < 2; ++parity) {
      for (int i = 0; 2 * i < input_.width; i += kFitLanes) {
        evaluate(i, parity, y);
      }
    }
  }

 private:
  /// Weighted sums of eight pixels, for each half.
  struct Sums {
    Float8 values[2][3];
    Float8 weights[2];
  };
  /// Evaluates the models of eight centres at eight pixels, one for each lane, and adds the values
  /// to the sums. The pixel of a lane is (2 (i + lane) + parity, y).
  /// Its centre is (2 (i + lane + k), cy).
  void add_centres(int i, int parity, int y, int k, int cy, Sums& sums) const;
  /// Computes the eight pixels (2 (i + lane) + parity, y).
  void evaluate(int i, int parity, int y);

  const FitInput& input_;
  const int first_row_;
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
  const int row = cy / 2 - first_row_;
  for (std::size_t h = 0; h < 2; ++h) {
    const Float8 weight = Float8::load(models_.weights.row(Models::weight(h, dx, dy), row) + i + k);
    for (std::size_t c = 0; c < 3; ++c) {
      Float8 value(0.0f);
      for (std::size_t t = 0; t < kTerms; ++t) {
        const float* const of = models_.coefficients.row(Models::coefficient(h, t, c), row) + i + k;
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
    // Where no centre resembles the pixel, the pixel keeps its own value.
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
  const auto row =
      static_cast<std::size_t>(y - input_.wanted.first) * static_cast<std::size_t>(input_.width);
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

FitOutputs fit(const FitInput& input, const FilterSettings& settings, Pool& pool) {
  const RowSpan wanted = input.wanted;
  // Rows of centres, up to kNear from the wanted rows.
  const int first = std::max(0, wanted.first - kNear + 1) / 2;
  const int last = std::min(input.height + 1, wanted.last + kNear + 1) / 2;
  const int columns = (input.width + 1) / 2;
  AllModels models{Models(columns, last - first), Models(columns, last - first)};
  const int across = (columns + kTileColumns - 1) / kTileColumns;
  const int down = (last - first + kTileRows - 1) / kTileRows;
  pool.parallel_for(std::int64_t{across} * down, [&](std::int64_t tile) {
    TileFit(input, settings, first, models)
        .run(static_cast<int>(tile % across) * kTileColumns,
             first + static_cast<int>(tile / across) * kTileRows, last);
  });
  FitOutputs outputs;
  for (std::size_t f = 0; f < kFilters; ++f) {
    for (auto& half : outputs[f].halves) {
      for (auto& channel : half) {
        channel.resize(static_cast<std::size_t>(input.width) *
                       static_cast<std::size_t>(wanted.count()));
      }
    }
    pool.parallel_for(wanted.count(), [&](std::int64_t row) {
      Evaluation(input, first, models[f], outputs[f]).run(wanted.first + static_cast<int>(row));
    });
  }
  return outputs;
}

}  // namespace bandsaw
