#include "renderlib/denoise/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/denoise/maps.h"
#include "renderlib/denoise/prepare.h"

namespace bandsaw {
namespace {

/// The filters among which is chosen, pixel by pixel: a narrow and a wide one.
constexpr FitSettings kFilters[] = {
    {.color_reach = 0.7f, .albedo_reach = 2, .normal_reach = 0.3f, .depth_reach = 0.025f},
    {.color_reach = 1.5f, .albedo_reach = 2, .normal_reach = 0.3f, .depth_reach = 0.05f}};
constexpr std::size_t kCount = std::size(kFilters);

using Fits = std::array<FitOutput, kCount>;
/// Shares of the rendered value and of each filter in a pixel's value.
using Shares = std::array<Map, 1 + kCount>;

float channel(const Rgb& color, std::size_t c) {
  return c == 0 ? color.r : c == 1 ? color.g : color.b;
}

/// Estimates the squared error of the mean of two values, each of which was computed from one part
/// of the samples (`a` from the first). `first` and `second` are the parts' own values. With the
/// variance v of a part's value, E (a - second)^2 = error^2(a) + v(second), because the parts are
/// independent, and v(second) = share (first - second)^2 on average; and the same exchanged. The
/// mean's error is less than that of its terms by share (1 - share) (a - b)^2.
template <class T>
T squared_error(T a, T b, T first, T second, T share) {
  const T apart = (first - second) * (first - second);
  const T of_a = (a - second) * (a - second) - share * apart;
  const T of_b = (b - first) * (b - first) - (1 - share) * apart;
  return share * of_a + (1 - share) * of_b - share * (1 - share) * ((a - b) * (a - b));
}

class Selection {
 public:
  Selection(const DenoiseInput& input, const FitInput& planes, const Fits& fits, Pool& pool)
      : input_(input),
        planes_(planes),
        fits_(fits),
        pool_(pool),
        size_{planes.width, planes.height},
        smoothing_(planes, pool) {
    choose();
  }

  Denoised result() const;

 private:
  /// Calls f(x, y, index) for all pixels, on the threads of the pool.
  template <class F>
  void each(F f) const {
    pool_.parallel_for(size_.height, [&](std::int64_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < size_.width; ++x) {
        f(x, y, size_.index(x, y));
      }
    });
  }
  /// Returns 1 / (brightness^2 + a little), so that errors of all pixels count alike.
  Map scales() const;
  Map error_of(std::size_t candidate, const Map& scale) const;
  void choose();
  /// Half `h` of the result.
  float mixed(int x, int y, std::size_t h, std::size_t c) const;
  Rgb value_of(int x, int y) const;

  const DenoiseInput& input_;
  const FitInput& planes_;
  const Fits& fits_;
  Pool& pool_;
  MapSize size_;
  SurfaceSmoothing smoothing_;
  Shares shares_;
};

Map Selection::scales() const {
  Map bright(size_.pixels());
  double sum = 0;
  for (std::size_t i = 0; i < size_.pixels(); ++i) {
    for (const auto& half : fits_.back().halves) {
      bright[i] += ((half[0][i] + half[1][i]) + half[2][i]) / 6;
    }
    sum += bright[i];
  }
  const auto mean = static_cast<float>(sum / static_cast<double>(size_.pixels()));
  for (float& value : bright) {
    value = 1 / (value * value + 0.03f * mean * mean + 1e-30f);
  }
  return bright;
}

/// Returns the estimated squared error of candidate 0 (the rendered value) or of a filter.
Map Selection::error_of(std::size_t candidate, const Map& scale) const {
  Map error(size_.pixels());
  each([&](int x, int y, std::size_t i) {
    const float share = input_.first_share[i];
    float sum = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float first = planes_.halves[0][c].at(x, y);
      const float second = planes_.halves[1][c].at(x, y);
      const float a = candidate == 0 ? first : fits_[candidate - 1].halves[0][c][i];
      const float b = candidate == 0 ? second : fits_[candidate - 1].halves[1][c][i];
      sum += squared_error(a, b, first, second, share);
    }
    error[i] = planes_.valid.at(x, y) > 0 ? sum * scale[i] : 0;
  });
  smoothing_.apply(error, pool_);
  return error;
}

void Selection::choose() {
  const Map scale = scales();
  Map least = error_of(0, scale);
  for (Map& share : shares_) {
    share.assign(size_.pixels(), &share == shares_.data() ? 1.0f : 0.0f);
  }
  for (std::size_t k = 1; k <= kCount; ++k) {
    const Map error = error_of(k, scale);
    each([&](int, int, std::size_t i) {
      if (error[i] < least[i]) {
        least[i] = error[i];
        for (Map& share : shares_) {
          share[i] = 0;
        }
        shares_[k][i] = 1;
      }
    });
  }
  // Sharp limits between filters would be seen.
  for (Map& share : shares_) {
    smoothing_.apply(share, pool_);
  }
}

float Selection::mixed(int x, int y, std::size_t h, std::size_t c) const {
  const std::size_t i = size_.index(x, y);
  float value = shares_[0][i] * planes_.halves[h][c].at(x, y);
  for (std::size_t k = 0; k < kCount; ++k) {
    value += shares_[k + 1][i] * fits_[k].halves[h][c][i];
  }
  return value;
}

bool is_rendered(float valid, float share_1, float share_2) {
  return !(valid > 0) || !(share_1 + share_2 > 0);
}

Rgb Selection::value_of(int x, int y) const {
  const std::size_t i = size_.index(x, y);
  if (is_rendered(planes_.valid.at(x, y), shares_[1][i], shares_[2][i])) {
    return input_.mean.pixels[i];
  }
  const float share = input_.first_share[i];
  const auto value = [&](std::size_t c) {
    return share * mixed(x, y, 0, c) + (1 - share) * mixed(x, y, 1, c);
  };
  return {value(0), value(1), value(2)};
}

Denoised Selection::result() const {
  struct RowSums {
    double value = 0;
    double raw = 0;
    double clean = 0;
    double variance = 0;
  };
  std::vector<RowSums> rows(static_cast<std::size_t>(size_.height));
  Denoised out;
  out.image = input_.mean;
  Map errors(size_.pixels());
  each([&](int x, int y, std::size_t i) {
    RowSums& sums = rows[static_cast<std::size_t>(y)];
    out.image.pixels[i] = value_of(x, y);
    if (!(planes_.valid.at(x, y) > 0)) {
      return;
    }
    const bool rendered = is_rendered(1, shares_[1][i], shares_[2][i]);
    const double share = input_.first_share[i];
    double of_pixel = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float mean = channel(input_.mean.pixels[i], c);
      const double first = channel(input_.first.pixels[i], c);
      const double second =
          second_value(mean, channel(input_.first.pixels[i], c), input_.first_share[i]);
      const double a = rendered ? first : mixed(x, y, 0, c);
      const double b = rendered ? second : mixed(x, y, 1, c);
      of_pixel += squared_error(a, b, first, second, share);
      sums.variance += share * (1 - share) * ((a - b) * (a - b));
      sums.raw += share * (1 - share) * ((first - second) * (first - second));
      sums.value += mean;
    }
    sums.clean += of_pixel;
    errors[i] = static_cast<float>(std::clamp(of_pixel / 3, -1e30, 1e30));
  });
  smoothing_.apply(errors, pool_);
  out.error = {input_.mean.width, input_.mean.height, {}};
  for (const float error : errors) {
    out.error.pixels.push_back(gray(std::sqrt(std::max(0.0f, error))));
  }
  RowSums all;
  for (const RowSums& row : rows) {
    all.value += row.value;
    all.raw += row.raw;
    all.clean += row.clean;
    all.variance += row.variance;
  }
  const double count = 3 * static_cast<double>(size_.pixels());
  out.total = {
      .mean = all.value / count,
      .rmse_raw = std::sqrt(all.raw / count),
      .rmse_clean = std::sqrt(std::max(0.0, all.clean) / count),
      .bias_share = all.clean > 0 ? std::clamp(1 - all.variance / all.clean, 0.0, 1.0) : 0};
  return out;
}

}  // namespace

Denoised denoise(const DenoiseInput& input, FitFunction fit, Pool& pool) {
  const FitInput planes = prepare_fit(input, pool);
  Fits fits;
  for (std::size_t k = 0; k < kCount; ++k) {
    fits[k] = fit(planes, kFilters[k], pool);
  }
  return Selection(input, planes, fits, pool).result();
}

}  // namespace bandsaw
